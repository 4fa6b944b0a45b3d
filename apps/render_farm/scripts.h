// The forms of the scripts that run tasks; what stands in braces is filled in.
#pragma once

namespace cistula {

inline constexpr const char* task_script_form = R"form(#!/bin/sh
# Renders a task of tasks.txt, a line of frames, tile and estimated seconds: task.sh N [more options of render].
# N counts from 0. What is complete stays as it is, so a task may be killed and run again, on two machines at once, too.
# CISTULA_FARM_ROOT: the folder in which the film's names are meant. CISTULA_BIN: the folder of render.
set -eu
number=$1
shift
farm=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
line=$(sed -n "$((number + 1))p" "$farm/tasks.txt")
if [ -z "$line" ]; then
    echo "task.sh: there is no task $number" >&2
    exit 2
fi
frames=$(printf '%s\n' "$line" | cut -f 1)
tile=$(printf '%s\n' "$line" | cut -f 2)
root=${{CISTULA_FARM_ROOT:-{root}}}
programs=${{CISTULA_BIN:-{programs}}}
cd -- "$root"
status=0
"$programs/render" {scene}{passed} -o {output} -f "$frames"{tile} --resume "$@" || status=$?
if [ "$status" -eq 5 ]; then # a target error is missed in some pixels; the files are written
    status=0
fi
exit "$status"
)form";

inline constexpr const char* finish_script_form = R"form(#!/bin/sh
# {what}, and writes the hashes of the film's files to manifest.sha256. To be run after all tasks.
# CISTULA_FARM_ROOT, CISTULA_BIN: as of task.sh.
set -eu
farm=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
root=${{CISTULA_FARM_ROOT:-{root}}}
programs=${{CISTULA_BIN:-{programs}}}
cd -- "$root"
status=0
{finish} || status=$?
if [ "$status" -ne 0 ] && [ "$status" -ne 5 ]; then
    exit "$status"
fi
trap 'rm -f -- "$farm/.manifest.$$"' EXIT
xargs -0 sha256sum -- <"$farm/files.txt" >"$farm/.manifest.$$"
mv -- "$farm/.manifest.$$" "$farm/manifest.sha256"
)form";

inline constexpr const char* slurm_script_form = R"form(#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=task-%a.log
exec sh task.sh "$SLURM_ARRAY_TASK_ID"
)form";

inline constexpr const char* slurm_finish_form = R"form(#!/bin/sh
#SBATCH --job-name={name}-finish
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=finish.log
exec sh finish.sh
)form";

inline constexpr const char* submit_script = R"form(#!/bin/sh
# Submits the tasks to Slurm, and what comes after all of them. Prints the numbers of both jobs.
# submit.sh [options of sbatch for both]. After a failure the same again goes on from what is complete.
set -eu
farm=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
tasks=$(sbatch --parsable --chdir="$farm" "$@" "$farm/job.slurm")
tasks=${tasks%%;*}
finish=$(sbatch --parsable --chdir="$farm" --dependency="afterok:$tasks" --kill-on-invalid-dep=yes "$@" "$farm/finish.slurm")
echo "$tasks ${finish%%;*}"
)form";

inline constexpr const char* makefile_form =
    R"form(# make -j N -f Makefile: N tasks at a time, then finish.sh. What is complete stays as it is.
# GNU parallel, in this folder: seq 0 {last} | parallel sh task.sh && sh finish.sh
farm := $(patsubst %Makefile,%,$(MAKEFILE_LIST))
tasks := $(addprefix task-,$(shell seq 0 {last}))
.PHONY: finish $(tasks)
finish: $(tasks)
	sh "$(farm)finish.sh"
$(tasks): task-%:
	sh "$(farm)task.sh" $*
)form";

}  // namespace cistula
