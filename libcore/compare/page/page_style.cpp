#include "compare/page/page_parts.h"

namespace cistula {

const char* const page_style = R"(
:root { color-scheme: light dark;
  --ink: #17202b; --soft: #566273; --paper: #fbfbfa; --card: #fff; --line: #dfe3e8; --accent: #2f55d4; --code: #f0f2f5;
  --good: #0d6b3c; --bad: #b3261e; --badpaper: #fdecea; --chosen: #eef3ff;
  --s0: #2f55d4; --s1: #0b8f77; --s2: #c9580a; --s3: #a02c86; --s4: #7a6a12; --s5: #8591a1; --s6: #17202b; }
@media (prefers-color-scheme: dark) { :root {
  --ink: #e3e8ee; --soft: #9aa7b6; --paper: #12161b; --card: #191f26; --line: #2d3640; --accent: #8fa9ff; --code: #202831;
  --good: #6fd7a0; --bad: #ff8f85; --badpaper: #3a1f1d; --chosen: #1e2740;
  --s0: #8fa9ff; --s1: #4fd1b5; --s2: #ffa561; --s3: #e78fd3; --s4: #dac85a; --s5: #748292; --s6: #e3e8ee; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 0 1.25rem 4rem; max-width: 74rem; color: var(--ink); background: var(--paper);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; overflow-wrap: break-word; }
header { padding: 2.5rem 0 1rem; } .brand { margin: 0; color: var(--accent); font-weight: 650; letter-spacing: .04em; }
h1 { font-size: clamp(1.7rem, 4.5vw, 2.5rem); line-height: 1.15; margin: .2rem 0 .6rem; letter-spacing: -.015em; }
h2 { font-size: 1.45rem; margin: 0 0 .8rem; letter-spacing: -.01em; } h3 { font-size: 1.12rem; margin: 2rem 0 .6rem; }
header p { color: var(--soft); margin: 0; } header .brand { color: var(--accent); }
section { padding-top: 2.2rem; margin-top: 2.2rem; border-top: 1px solid var(--line); }
a { color: var(--accent); } nav ul { display: flex; flex-wrap: wrap; gap: .35rem .5rem; list-style: none; margin: 1rem 0 0; padding: 0; }
nav a { display: block; padding: .3rem .75rem; border: 1px solid var(--line); border-radius: 99px; text-decoration: none; background: var(--card); font-size: .9rem; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(15rem, 1fr)); gap: 1rem; margin-top: 1.4rem; }
.card { display: block; padding: 1rem 1.2rem; border: 1px solid var(--line); border-radius: 12px; background: var(--card); color: inherit; text-decoration: none; }
.card h2 { font-size: 1rem; margin: 0; } .card .big { font-size: 2.1rem; font-weight: 650; color: var(--accent); line-height: 1.2; }
.card p { margin: .1rem 0; font-size: .9rem; }
a:hover, .card:hover { border-color: var(--accent); } :focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
figure { margin: 0 0 1.4rem; padding: 1rem; border: 1px solid var(--line); border-radius: 12px; background: var(--card); min-width: 0; display: flex; flex-direction: column; }
figcaption { color: var(--soft); font-size: .9rem; margin-top: .6rem; } figcaption b { color: var(--ink); }
.pair { display: grid; margin-top: 1.2rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); gap: 0 1.2rem; }
img { display: block; max-width: 100%; height: auto; border-radius: 6px; margin: 0 auto; }
.chart { display: block; width: 100%; height: auto; } .narrow { display: none; }
.chart text { font: 14px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; fill: var(--soft); } .chart .axis { fill: var(--ink); }
.chart .word { fill: var(--ink); font-weight: 650; } .grid { stroke: var(--line); fill: none; } .frame { stroke: var(--soft); fill: none; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; } .line.dashed { stroke-dasharray: 6 5; stroke-width: 1.6; }
.range { stroke-width: 1.5; opacity: .6; fill: none; } .dot.faint, .range.faint { opacity: .28; } .ring { fill: none; stroke: var(--ink); stroke-width: 2; }
.dot { stroke: var(--card); stroke-width: 1; }
.line.s0, .range.s0 { stroke: var(--s0); } .line.s1, .range.s1 { stroke: var(--s1); } .line.s2, .range.s2 { stroke: var(--s2); }
.line.s3, .range.s3 { stroke: var(--s3); } .line.s4, .range.s4 { stroke: var(--s4); } .line.s5, .range.s5 { stroke: var(--s5); } .line.s6, .range.s6 { stroke: var(--s6); }
.dot.s0, .bar.s0 { fill: var(--s0); } .dot.s1, .bar.s1 { fill: var(--s1); } .dot.s2, .bar.s2 { fill: var(--s2); }
.dot.s3, .bar.s3 { fill: var(--s3); } .dot.s4, .bar.s4 { fill: var(--s4); } .dot.s5, .bar.s5 { fill: var(--s5); } .dot.s6, .bar.s6 { fill: var(--s6); }
.legend { display: flex; flex-wrap: wrap; gap: .15rem 1rem; list-style: none; margin: 0 0 .5rem; padding: 0; font-size: .88rem; }
.key { display: inline-block; width: .72em; height: .72em; border-radius: 50%; margin-right: .4em; background: var(--k); }
.key.square, .key.block { border-radius: 2px; } .key.diamond { border-radius: 1px; transform: rotate(45deg); } .key.dashed { border-radius: 0; width: 1.6em; height: 0; background: none; border-top: 2px dashed var(--k); vertical-align: .25em; }
.key.s0 { --k: var(--s0); } .key.s1 { --k: var(--s1); } .key.s2 { --k: var(--s2); } .key.s3 { --k: var(--s3); } .key.s4 { --k: var(--s4); } .key.s5 { --k: var(--s5); } .key.s6 { --k: var(--s6); }
.scroll { overflow-x: auto; margin: 0 0 1.2rem; border: 1px solid var(--line); border-radius: 12px; background: var(--card); }
table { border-collapse: collapse; width: 100%; font-size: .92rem; } caption { caption-side: top; text-align: left; padding: .7rem .8rem .3rem; color: var(--soft); }
caption span { position: sticky; left: .8rem; display: inline-block; max-width: min(100%, calc(100vw - 4rem)); }
th, td { padding: .42rem .8rem; text-align: left; vertical-align: top; border-top: 1px solid var(--line); font-weight: 400; }
thead th { border-top: 0; color: var(--soft); font-weight: 600; font-size: .84rem; vertical-align: bottom; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; } td small, th small { display: block; color: var(--soft); font-size: .8rem; }
tbody th { min-width: 9rem; } tbody th.n { min-width: 0; } tr.chosen { background: var(--chosen); } tr.bad { background: var(--badpaper); }
.tag { font-size: .78rem; padding: .05rem .5rem; border-radius: 99px; background: var(--accent); color: var(--card); font-weight: 600; }
.good { color: var(--good); } .bad { color: var(--bad); } tr.bad { color: inherit; }
code { font: .9em ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; }
.command { margin: 0 0 1.2rem; padding: .8rem 1rem; white-space: pre-wrap; overflow-wrap: anywhere; background: var(--code); border-radius: 10px; user-select: all; }
.note { color: var(--soft); font-size: .9rem; } details { margin: 0 0 1.2rem; } summary { cursor: pointer; color: var(--accent); margin-bottom: .6rem; }
.meter { display: block; width: 8rem; height: .7rem; margin-top: .45rem; border-radius: 99px; background: var(--code); overflow: hidden; } .meter span { display: block; height: 100%; background: var(--s0); }
.scale { height: .7rem; border-radius: 99px; margin-top: .8rem; } .ends { display: flex; justify-content: space-between; font-size: .85rem; color: var(--soft); }
.flip { position: relative; width: fit-content; max-width: 100%; margin: 0 auto; } .flip .over { position: absolute; inset: 0; opacity: 0; } .flip:hover .over, .flip:focus .over { opacity: 1; }
.badge { position: absolute; left: .6rem; top: .6rem; padding: .1rem .6rem; border-radius: 99px; background: rgba(0,0,0,.66); color: #fff; font-size: .85rem; }
.flip .two, .flip:hover .one, .flip:focus .one { opacity: 0; } .flip:hover .two, .flip:focus .two { opacity: 1; }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); gap: .7rem 1.5rem; margin: 0 0 1.2rem; }
dt { color: var(--soft); font-size: .85rem; } dd { margin: 0; overflow-wrap: anywhere; }
.note code { overflow-wrap: anywhere; }
@media (max-width: 640px) { body { padding: 0 .8rem 3rem; } figure { padding: .7rem; } .wide { display: none; } .narrow { display: block; }
  :not(.narrow) > .chart text { font-size: 17px; } .scroll, figure { border-radius: 10px; } th, td { padding: .4rem .6rem; } }
@media print { nav { display: none; } section { break-inside: auto; } figure { break-inside: avoid; } }
)";

}  // namespace cistula
