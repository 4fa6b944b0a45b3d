#include "job_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scripts.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string words(const std::vector<std::string>& arguments) {
    std::string text;
    for (const std::string& argument : arguments) text += ' ' + shell_word(argument);
    return text;
}

std::string tasks_text(const FarmJob& job) {
    std::string text;
    for (const FarmTask& task : job.tasks)
        text += fmt::format("{}\t{}\t{:.1f}\n", format_frames(task.frames), task.tile, task.seconds);
    return text;
}

std::string tiles_option(const FarmJob& job) {
    return job.tiles ? fmt::format(" --tiles {}x{}", job.tiles->columns, job.tiles->rows) : "";
}

std::string task_script(const FarmJob& job) {
    const std::string tile = job.tiles ? tiles_option(job) + " --tile \"$tile\"" : "";
    return fmt::format(task_script_form, fmt::arg("root", shell_word(job.root)),
                       fmt::arg("programs", shell_word(job.programs)), fmt::arg("scene", shell_word(job.scene)),
                       fmt::arg("passed", words(job.passed)), fmt::arg("output", shell_word(job.output)),
                       fmt::arg("tile", tile));
}

std::string finish_script(const FarmJob& job) {
    const std::string frames = format_frames(job.frames), output = shell_word(job.output);
    const std::string finish = job.tiles ? fmt::format("\"$programs/render-merge\"{} -f {} -o {}{} -q",
                                                       tiles_option(job), frames, output, words(job.merged))
                                         : fmt::format("\"$programs/render\" {}{} -o {} -f {} --resume -q",
                                                       shell_word(job.scene), words(job.passed), output, frames);
    return fmt::format(finish_script_form, fmt::arg("root", shell_word(job.root)),
                       fmt::arg("programs", shell_word(job.programs)), fmt::arg("finish", finish),
                       fmt::arg("what", job.tiles ? "Puts the tiles together" : "Renders what is missing"));
}

/// What a step runs: the shell with these arguments.
Json script_of(const Json& arguments) {
    const Json cancelation = {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 30}};
    const Json run = {{"command", "sh"}, {"args", arguments}, {"cancelation", cancelation}};
    return {{"actions", {{"onRun", run}}}};
}

/// The job as a template of Open Job Description.
std::string openjd_template(const FarmJob& job) {
    const Json folder = {
        {"name", "Farm"},      {"type", "PATH"}, {"objectType", "DIRECTORY"},
        {"dataFlow", "INOUT"}, {"default", "."}, {"description", "The folder of task.sh and finish.sh."}};
    const Json task = {{"name", "Task"}, {"type", "INT"}, {"range", fmt::format("0-{}", job.tasks.size() - 1)}};
    const Json render = {
        {"name", "Render"},
        {"parameterSpace", {{"taskParameterDefinitions", Json::array({task})}}},
        {"script", script_of(Json::array({"{{Param.Farm}}/task.sh", "{{Task.Param.Task}}", "--progress=openjd"}))}};
    const Json after = {{"dependsOn", "Render"}};
    const Json finish = {{"name", "Finish"},
                         {"dependencies", Json::array({after})},
                         {"script", script_of(Json::array({"{{Param.Farm}}/finish.sh"}))}};
    const Json form = {{"specificationVersion", "jobtemplate-2023-09"},
                       {"name", job.name},
                       {"parameterDefinitions", Json::array({folder})},
                       {"steps", Json::array({render, finish})}};
    return form.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string shell_word(const std::string& text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::vector<JobFile> job_files(const FarmJob& job) {
    const size_t last = job.tasks.size() - 1;
    return {{"tasks.txt", tasks_text(job)},
            {"task.sh", task_script(job)},
            {"finish.sh", finish_script(job)},
            {"job.openjd.json", openjd_template(job)},
            {"job.slurm", fmt::format(slurm_script_form, fmt::arg("name", job.name), fmt::arg("last", last))},
            {"finish.slurm", fmt::format(slurm_finish_form, fmt::arg("name", job.name))},
            {"submit.sh", submit_script},
            {"Makefile", fmt::format(makefile_form, fmt::arg("last", last))}};
}

}  // namespace cistula
