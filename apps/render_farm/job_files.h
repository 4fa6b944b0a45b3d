// The files of a job: one task list, and what runs it by Open Job Description, by Slurm and by make.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan.h"
#include "render/picture_size.h"

namespace cistula {

/// A film as a job.
struct FarmJob {
    std::string name;      // of the job, from the scene's
    std::string root;      // the folder in which render and its names are meant
    std::string programs;  // the folder of render and render-merge
    std::string scene, output;
    std::vector<std::string> passed, merged;  // arguments for render and render-merge
    std::optional<TileGrid> tiles;
    std::vector<int> frames;
    std::vector<FarmTask> tasks;
};

struct JobFile {
    std::string name, text;
};

/// All of them but the list of the film's files. Every task is `sh task.sh N`, and after all of them comes
/// `sh finish.sh`.
std::vector<JobFile> job_files(const FarmJob& job);

/// A text as one word of the shell.
std::string shell_word(const std::string& text);

}  // namespace cistula
