#!/usr/bin/env python3
"""Runs the commands of the pages, and looks for programs, targets of make and options that there are not.

A ```sh block has commands. Those of a page run in their order, in a folder of its own that has scenes/ and the Makefile, build/release
and the programs on the PATH; `make` compiles nothing there, and does what else its targets do. A ```console block has lines
`$ COMMAND`, each with all that it prints, or `...` for some lines. Commands of NOT_RUN, those in `code` and in other blocks are only
looked up.

usage: check_pages.py ROOT BUILD [PAGE...] | --self-test BUILD
"""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# What does not run in this test, by how commands match, with the reason.
NOT_RUN = {
    r"^make (?!render|-j)": "builds, tests or installs everything",
    r"^cmake ": "builds",
    r"^bench/|bin/bench_": "measures for minutes",
    r"^tests/systems": "needs root and network",
    r"(--backend|--device) (cuda|all)": "needs a GPU",
    r"/usr/local/share|^example/": "needs the installed package, whose test does the same (tests/package)",
    r"^(oiiotool|ffmpeg)": "runs in tests/clients/check",
    r"^render-verify --quick$": "takes two minutes",
    r"^(seq .*parallel|sh farm/submit.sh|deadline) ": "needs GNU parallel, Slurm or Deadline",
}
OF_OTHERS = {"--gpus-per-task"}  # options of other programs, which pages name
WITHOUT_PACKAGE = r"^(\$ )?(cistula (report|view)|openjd) "  # not run where the build has no Python package

# What pages presume of the folder in which their commands run.
SUITE = r"""mkdir -p tests/golden && cp -r scenes tests/golden && cp scenes/seed.json tests/golden/scenes/film.json
awk '/^```/ { json = $0 == "```json"; next } json' "$ROOT/docs/regression.md" >tests/golden/suite.json"""
PRESUMED = {"docs/regression.md": SUITE, "docs/programs/suites.md": SUITE + "\nrender-compare suite tests/golden --update"}

PRELUDE = r"""make() {
    case " $* " in *" -f "*) command make "$@"; return ;; esac
    local lines
    lines=$(command make -n "$@" SETUP=no | grep -vE '^[ \t]*(true$|cmake)')
    [ -n "$lines" ] || { echo "make $*: nothing but building is left of it" >&2; return 1; }
    BASH_ENV= bash -euo pipefail -c "$lines"
}
into() { "${@:2}" >"$1" 2>&1 || :; }
trap 'echo "$PAGE:$LINENO: this command fails" >&2' ERR
"""
PROGRAMS = ("render", "render-compare", "render-compare suite", "render-merge", "render-verify",
            "cistula farm", "cistula import", "cistula report", "cistula view")
OPTION = re.compile(r"(?<![\w.-])--?[a-z][a-z0-9-]*")
CALL = re.compile(r"(?:^|(?<=[\s`]))(?:[\w./]+/)?(render-compare suite|render(?:-[a-z]+)?|cistula [a-z]+)(?= |$)([^`;&#]*)")


def pages(root: Path) -> list[Path]:
    """All pages but records, which tell of what is gone, too."""
    found = [*root.glob("*.md"), *root.glob("docs/**/*.md")]
    return sorted(page for page in found if page.name != "CHANGELOG.md" and "decisions" not in page.parts)


def blocks(lines: list[str]) -> Iterator[tuple[str | None, int, list[str]]]:
    """Language, number of the first line and lines of each fenced block, and of the text between them, whose language is None."""
    language: str | None = None
    first = 0
    for number, line in enumerate([*lines, "```"]):
        if line.startswith("```"):
            yield language, first + 1, lines[first:number]
            language, first = line[3:] if language is None else None, number + 1


def commands(language: str | None, first: int, lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    """The commands of a block, each with the number of its first line and its lines."""
    number = 0
    while number < len(lines):
        end = number + 1
        while language == "sh" and lines[end - 1].endswith("\\") and end < len(lines):
            end += 1
        if lines[number].startswith("$ ") if language == "console" else language == "sh" and lines[number].strip(" ")[:1] not in ("", "#"):
            yield first + number, lines[number:end]
        number = end


class Check:
    """A check of a source tree and a build of it; `faults` are lines of what is wrong."""

    def __init__(self, root: Path, build: Path, scratch: Path) -> None:
        self.root, self.build, self.scratch = root, build, scratch
        self.faults: list[str] = []
        self.matched: set[str] = set()
        venv = build.parent / "python/bin"
        has_package = venv.exists() and (build / "python").exists()
        self.not_run = NOT_RUN if has_package else NOT_RUN | {WITHOUT_PACKAGE: "the build has no Python package"}
        (scratch / "bin").mkdir()
        shim = scratch / "bin/cistula"
        shim.write_text(f'#!/bin/sh\nPYTHONPATH="{build if has_package else root}/python" PYTHONDONTWRITEBYTECODE=1 '
                        f'exec "{venv / "python" if has_package else sys.executable}" -m cistula "$@"\n')
        shim.chmod(0o755)
        (scratch / "prelude").write_text(PRELUDE)
        own = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "PYTHONPATH")  # of what runs this
        self.environment = {name: value for name, value in os.environ.items() if name not in own} | {
            "ROOT": str(root), "PATH": f"{shim.parent}:{build}/bin:{venv}:{os.environ['PATH']}"}
        self.options = {program: self.listed(program) for program in PROGRAMS}
        self.options["render"].add("--aov")
        self.options["cistula farm"] |= self.options["render"]
        self.options |= {"cistula render": self.options["render"], "cistula verify": self.options["render-verify"],
                         "cistula compare": self.options["render-compare"] | self.options["render-compare suite"]}
        scripts = [file for folder in ("bench", "cmake", "python", "tests", "docs") for file in (root / folder).rglob("*")
                   if file.suffix in ("", ".py", ".sh", ".cmake") and file.is_file()]
        self.anywhere: set[str] = OF_OTHERS.union(*self.options.values(), *(OPTION.findall(file.read_text()) for file in scripts))

    def listed(self, program: str) -> set[str]:
        """The options that a program's --help lists. Python's commands need NumPy for that: without the package, those that
        any of their sources names."""
        if program.startswith("cistula ") and WITHOUT_PACKAGE in self.not_run:
            sources = (self.root / "python/cistula").rglob("*.py")
            return {"--version", *OPTION.findall("\n".join(source.read_text() for source in sources))}
        answer = subprocess.run([*program.split(), "--help"], env=self.environment, capture_output=True, text=True, check=True)
        return {"--version", *OPTION.findall(answer.stdout)}

    def look_up(self, page: str, line: int, text: str, is_command: bool) -> None:
        """Names what in a text, a command or one that may have some, is not there."""
        text = re.sub(r"(^| )# .*", "", text)
        word, *rest = text.split() or [""]
        script = self.root / word if is_command and "/" in word and not word.startswith("build/") else None
        if script and script.is_file():
            for option in set(OPTION.findall(text)) - set(OPTION.findall(script.read_text())) - self.options["render"]:
                self.faults.append(f"{page}:{line}: {word} has no {option}")
            return
        for program, words in CALL.findall(text):
            known = self.options.get(program)
            if known is None:
                self.faults.append(f"{page}:{line}: there is no {program}")
            for option in set(OPTION.findall(words)) - (known or self.anywhere):
                self.faults.append(f"{page}:{line}: {program} has no {option}")
        if word == "make" and is_command and "-f" not in rest:
            for target in re.findall(r"^make ([a-z][a-z-]*)\b(?!=)", text):
                if not re.search(rf"^{target}:", (self.root / "Makefile").read_text(), re.M):
                    self.faults.append(f"{page}:{line}: there is no make {target}")

    def page(self, path: Path) -> None:
        """Looks up what a page names, and runs its commands."""
        page = str(path.relative_to(self.root))
        lines = path.read_text().splitlines()
        script = [""] * (len(lines) + 1)  # each command in its line of the page
        printed: dict[int, list[str]] = {}
        folder = self.scratch / page.replace("/", "-")
        for language, first, block in blocks(lines):
            for number, line in enumerate(block, first):
                if language not in (None, "sh"):
                    self.look_up(page, number, line, False)
                for code in re.findall(r"`([^`]+)`", line) if language is None else ():
                    self.look_up(page, number, code, True)
                    for option in {word for word in OPTION.findall(code) if word.startswith("--")} - self.anywhere:
                        self.faults.append(f"{page}:{number}: no program has {option}")
            for number, command in commands(language, first, block):
                text = command[0].removeprefix("$ ")
                self.look_up(page, number, text, True)
                reasons = [pattern for pattern in self.not_run if re.search(pattern, text)]
                self.matched.update(reasons)
                if reasons:
                    continue
                if language == "sh":
                    script[number - 1:number - 1 + len(command)] = command
                else:
                    script[number - 1] = f"into '{folder}.{number}' {text}"
                    after = block[number - first + 1:]
                    printed[number] = after[:next((i for i, line in enumerate(after) if line.startswith("$ ")), len(after))]
        if any(script):
            self.run(page, script, folder)
        for number, expected in printed.items():
            file = Path(f"{folder}.{number}")
            found = file.read_text() if file.exists() else "nothing"
            pattern = re.escape("".join(line + "\n" for line in expected)).replace(re.escape("...\n"), "(.*\n)*")
            if not re.fullmatch(pattern, found):
                self.faults.append(f"{page}:{number}: prints otherwise:\n{found}")

    def run(self, page: str, script: list[str], folder: Path) -> None:
        """Runs a page's commands in a folder."""
        folder.mkdir()
        for name in ("scenes", "Makefile"):
            if (self.root / name).exists():
                (shutil.copytree if (self.root / name).is_dir() else shutil.copy)(self.root / name, folder / name)
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(self.build)
        environment = self.environment | {"PAGE": page}
        if page in PRESUMED:
            subprocess.run(["bash", "-euc", PRESUMED[page]], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
        file = self.scratch / (folder.name + ".sh")
        file.write_text("\n".join(script) + "\n")
        answer = subprocess.run(["bash", "-euo", "pipefail", str(file)], cwd=folder, stdin=subprocess.DEVNULL, text=True, check=False,
                                env=environment | {"BASH_ENV": str(self.scratch / "prelude")}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if answer.returncode != 0:
            self.faults.append("\n".join(answer.stdout.replace(str(file), page).splitlines()[-20:]))


def self_test(build: Path) -> int:
    """Tries pages, each with what is to be found in it."""
    pages_of = {
        "```sh\nmake render\ntest -s out/image\n```\n```sh\ncat < Makefile | grep -q render\n```": "",
        "```sh\ntrue\n\ntrue &&\\\n  false\n```": "page.md:5: this command fails",
        "```sh\ntest -s out/image\nmake render\n```": "page.md:2: this command fails",
        "```sh\nfalse | true\n```": "page.md:2: this command fails",
        "```sh\nno-such-program\n```": "page.md: line 2: no-such-program",
        "```sh\nmake test none\n```": "page.md:2: there is no make test",
        "```sh\nrender none.json --backend cuda --none\n```": "page.md:2: render has no --none",
        "```console\n$ echo a\na\n$ false\n$ printf 'a\\nb\\nc\\n'\n...\nc\n```": "",
        "```console\n$ echo a\nb\n```": "page.md:2: prints otherwise:\na",
        "```console\n$ echo a\n```": "page.md:2: prints otherwise:\na",
        "```yaml\nrun: render-compare a b --none\n```": "page.md:2: render-compare has no --none",
        "Text, `render --none`": "page.md:1: render has no --none",
        "Text, `cistula paint`": "page.md:1: there is no cistula paint",
        "Text, `--none`": "page.md:1: no program has --none",
        "Text, `render-view a.exr`": "page.md:1: there is no render-view",
    }
    failures = 0
    for text, expected in pages_of.items():
        with tempfile.TemporaryDirectory() as folder:
            root, scratch = Path(folder) / "root", Path(folder) / "scratch"
            (scratch / "tests").mkdir(parents=True)
            shutil.copytree(Path(__file__).parent.parent / "python", root / "python", ignore=shutil.ignore_patterns("__pycache__"))
            (root / "Makefile").write_text("render:\n\t@true\n\tcmake --build x\n\tmkdir -p out\n\techo image >out/image\n")
            (root / "page.md").write_text(text + "\n")
            check = Check(root, build, scratch)
            check.page(root / "page.md")
            found = "\n".join(check.faults)
            if expected not in found or bool(found) != bool(expected):
                print(f"{text}\nexpected: {expected}\nfound: {found}\n")
                failures += 1
    print(f"{len(pages_of)} pages tried, {failures} failures")
    return 1 if failures else 0


def main() -> int:
    if len(sys.argv) == 3 and sys.argv[1] == "--self-test":
        return self_test(Path(sys.argv[2]).resolve())
    if len(sys.argv) < 3:
        print(str(__doc__).splitlines()[-1], file=sys.stderr)
        return 2
    root, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(os.cpu_count()) as pool:
        check = Check(root, build, Path(scratch))
        list(pool.map(check.page, [root / page for page in sys.argv[3:]] or pages(root)))
    if len(sys.argv) == 3:
        check.faults += [f"NOT_RUN: no command is like {pattern}" for pattern in NOT_RUN.keys() - check.matched]
    print(*check.faults, sep="\n", end="\n" if check.faults else "")
    return 1 if check.faults else 0


if __name__ == "__main__":
    sys.exit(main())
