#include "compare/page/page_parts.h"

namespace cistula {

const char* const page_style = R"(
:root { color-scheme: light dark;
  --ink: #17202b; --soft: #566273; --paper: #fbfbfa; --card: #fff; --line: #dfe3e8; --accent: #2f55d4; --code: #f0f2f5;
  --good: #0d6b3c; --bad: #b3261e; --badpaper: #fdecea; }
@media (prefers-color-scheme: dark) { :root {
  --ink: #e3e8ee; --soft: #9aa7b6; --paper: #12161b; --card: #191f26; --line: #2d3640; --accent: #8fa9ff; --code: #202831;
  --good: #6fd7a0; --bad: #ff8f85; --badpaper: #3a1f1d; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 0 1.25rem 4rem; max-width: 74rem; color: var(--ink); background: var(--paper);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; overflow-wrap: break-word; }
header { padding: 2.5rem 0 1rem; } .brand { margin: 0; color: var(--accent); font-weight: 650; letter-spacing: .04em; }
h1 { font-size: clamp(1.7rem, 4.5vw, 2.5rem); line-height: 1.15; margin: .2rem 0 .6rem; letter-spacing: -.015em; }
h2 { font-size: 1.45rem; margin: 0 0 .8rem; letter-spacing: -.01em; } h3 { font-size: 1.12rem; margin: 2rem 0 .6rem; }
header p { color: var(--soft); margin: 0; } header .brand { color: var(--accent); }
section { padding-top: 2.2rem; margin-top: 2.2rem; border-top: 1px solid var(--line); }
a { color: var(--accent); } :focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
figure { margin: 0 0 1.4rem; padding: 1rem; border: 1px solid var(--line); border-radius: 12px; background: var(--card); min-width: 0; display: flex; flex-direction: column; }
figcaption { color: var(--soft); font-size: .9rem; margin-top: .6rem; } figcaption b { color: var(--ink); }
.pair { display: grid; margin-top: 1.2rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); gap: 0 1.2rem; }
img { display: block; max-width: 100%; height: auto; border-radius: 6px; margin: 0 auto; }
.scroll { overflow-x: auto; margin: 0 0 1.2rem; border: 1px solid var(--line); border-radius: 12px; background: var(--card); }
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
th, td { padding: .42rem .8rem; text-align: left; vertical-align: top; border-top: 1px solid var(--line); font-weight: 400; }
thead th { border-top: 0; color: var(--soft); font-weight: 600; font-size: .84rem; vertical-align: bottom; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; } td small, th small { display: block; color: var(--soft); font-size: .8rem; }
tbody th { min-width: 9rem; } tbody th.n { min-width: 0; } tr.bad { background: var(--badpaper); }
.good { color: var(--good); } .bad { color: var(--bad); } tr.bad { color: inherit; }
code { font: .9em ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; }
.command { margin: 0 0 1.2rem; padding: .8rem 1rem; white-space: pre-wrap; overflow-wrap: anywhere; background: var(--code); border-radius: 10px; user-select: all; }
.note { color: var(--soft); font-size: .9rem; } details { margin: 0 0 1.2rem; } summary { cursor: pointer; color: var(--accent); margin-bottom: .6rem; }
@media (max-width: 640px) { body { padding: 0 .8rem 3rem; } figure { padding: .7rem; }
  .scroll, figure { border-radius: 10px; } th, td { padding: .4rem .6rem; } }
@media print { section { break-inside: auto; } figure { break-inside: avoid; } }
)";

}  // namespace cistula
