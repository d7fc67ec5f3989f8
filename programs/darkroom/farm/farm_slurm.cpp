// SPDX-License-Identifier: MIT
// darkroom farm slurm: what is missing of a sequence, cut into chunks, as an array job. Slurm is spoken to by its own
// commands.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <utility>

#include "confined/process.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "farm.hpp"
#include "farm_process.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/shell_text.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

// Slurm's MaxArraySize is 1001 where a site says nothing else.
constexpr std::size_t max_chunks = 1000;
constexpr std::size_t usual_chunk = 10;

struct SlurmOptions {
    FarmFlags work;
    NumberFlag chunk{"--chunk", {.least = 1, .most = max_frames, .is_whole = true}};
    NumberFlag cpus{"--cpus", {.least = 1, .most = 4096, .is_whole = true}};
    std::string partition, time, gpus, account, program;
    bool is_dry_run = false;
};

/// Of at most `size` frames each that follow one another in the sequence, as --frames has them. Between those that are
/// missing there may be some that are there, which tasks pass over.
std::vector<std::string> chunks_of(const FarmWork& work, const FrameNumbers& done, std::size_t size) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < work.frames.size();) {
        if (done.contains(work.frames[i].number)) {
            ++i;
            continue;
        }
        const std::size_t first = i;
        std::size_t last = i;
        for (; i < work.frames.size() && i - first < size; ++i)
            if (!done.contains(work.frames[i].number)) last = i;
        std::vector<long long> numbers;
        for (std::size_t frame = first; frame <= last; ++frame) numbers.push_back(work.frames[frame].number);
        out.push_back(work.is_range ? fmt::format("{}-{}", numbers.front(), numbers.back())
                                    : darkroom::frame_set_text(numbers));
    }
    return out;
}

/// The lines by which Slurm is told what a task needs. Their values are words, because sbatch splits such lines by
/// rules of its own.
Result<std::string> directives(const SlurmOptions& options, std::size_t chunks) {
    std::string out = fmt::format("#SBATCH --job-name=darkroom\n#SBATCH --array=0-{}\n", chunks - 1);
    out += "#SBATCH --requeue\n#SBATCH --output=/dev/null\n";
    std::size_t cpus = 0;
    DARKROOM_TRY(options.cpus.read_to(cpus));
    if (cpus > 0) out += fmt::format("#SBATCH --cpus-per-task={}\n", cpus);
    const std::array<std::pair<const char*, const std::string&>, 4> values{{{"--partition", options.partition},
                                                                            {"--time", options.time},
                                                                            {"--gpus", options.gpus},
                                                                            {"--account", options.account}}};
    for (const auto& [flag, value] : values) {
        const auto is_allowed = [](unsigned char c) {
            return std::isalnum(c) != 0 ||
                   std::string_view("_-.,:@").find(static_cast<char>(c)) != std::string_view::npos;
        };
        if (!std::ranges::all_of(value, is_allowed))
            return user_error(
                fmt::format("{} {}: allowed are letters, digits and _ - . , : @", flag, printable(value)));
        if (!value.empty()) out += fmt::format("#SBATCH {}={}\n", flag, value);
    }
    return out;
}

Result<std::string> script_of(const SlurmOptions& options, const FarmWork& work,
                              const std::vector<std::string>& chunks) {
    DARKROOM_TRY_VALUE(const std::string head, directives(options, chunks.size()));
    if (options.program.find('\n') != std::string::npos)
        return user_error(
            fmt::format("--program {}: holds a line break; allowed is one line", printable(options.program)));
    std::error_code error;
    const std::string here = fs::current_path(error).string();
    const std::string program =
        options.program.empty() ? shell_quoted(fs::read_symlink("/proc/self/exe", error).string()) : options.program;
    if (error) return darkroom::machine_error(fmt::format("the working folder cannot be found: {}", error.message()));
    const std::string folder = shell_quoted(work.folder.string());
    return fmt::format(
        "#!/bin/bash\n{}set -e\ncd -- {}\nmkdir -p -- {}\nchunks=({})\nchunk=${{chunks[SLURM_ARRAY_TASK_ID]}}\n"
        "exec >>{}/\"$chunk.log\" 2>&1\n{} farm task --frames \"$chunk\"{} {}\n",
        head, shell_quoted(here), folder, fmt::join(chunks, " "), folder, program,
        darkroom::ConfinedProcess::allows_unconfined() ? " --allow-unconfined" : "", shell_quoted(options.work.task()));
}

bool is_number(const std::string& id) { return !id.empty() && id.find_first_not_of("0123456789") == std::string::npos; }

/// What was submitted before may not be under way.
Result<> check_is_over(const FarmWork& work, const FarmJob& last) {
    const std::string& id = last.id;
    if (!is_number(id)) return {};
    const Result<ProcessOutcome> queue = run_process({"squeue", "-h", "-o", "%i", "-j", id}, ProcessOutput::Kept);
    if (!queue || queue->code != 0 || queue->out.empty()) return {};  // Slurm has forgotten it, or sbatch says why not
    return user_error(fmt::format("{}: job {} is not over; wait for it, or end it with `scancel {}`",
                                  printable(work.folder.string()), id, id));
}

/// Gives the number of the job.
Result<std::string> submit(const fs::path& script) {
    const Result<ProcessOutcome> outcome = run_process({"sbatch", "--parsable", script.string()}, ProcessOutput::Kept);
    if (!outcome)
        return darkroom::machine_error(
            fmt::format("{}: Slurm's commands are needed; --dry-run works without them", outcome.error().text));
    if (outcome->code != 0)
        return darkroom::machine_error(outcome->errors.empty() ? fmt::format("sbatch: ended with {}", outcome->code)
                                                               : outcome->errors.back());
    std::string id = outcome->out.substr(0, outcome->out.find_first_of(";\n"));  // behind a semicolon: the cluster
    if (!is_number(id))
        return darkroom::machine_error(fmt::format("sbatch: '{}' is not a job's number", printable(id)));
    return id;
}

/// With the script among the records, for who wants to read it; where it is not taken, nothing stays.
Result<std::string> submit(const fs::path& folder, const std::string& script) {
    DARKROOM_TRY(darkroom::make_own_folder(folder));
    std::error_code error;
    const fs::path file = fs::absolute(folder / "job.sh", error);
    DARKROOM_TRY(darkroom::write_own_file(file, std::as_bytes(std::span(script)), darkroom::FileOwner::Anyone));
    Result<std::string> id = submit(file);
    if (!id) {
        fs::remove(file, error);
        fs::remove(folder, error);  // empty, or it stays
    }
    return id;
}

Result<> run(const SlurmOptions& options, std::span<const darkroom::LookEntry> named) {
    DARKROOM_TRY_VALUE(const FarmWork work, options.work.work());
    DARKROOM_TRY_VALUE(FarmInputs inputs, options.work.check(work, named));
    std::size_t chunk = usual_chunk;
    DARKROOM_TRY(options.chunk.read_to(chunk));
    FarmJob job{.arguments = options.work.task(), .inputs = std::move(inputs), .names = work.names};
    for (const FarmFrame& frame : work.frames) {
        job.frames.insert(frame.number);
        if (is_there(frame.picture)) job.done.insert(frame.number);
    }
    DARKROOM_TRY_VALUE(const std::optional<FarmJob> last, read_job(work.folder));
    if (!last && !job.done.empty())
        warn(fmt::format("{}: {} pictures are there, and no record says of which look: they count as made",
                         printable(work.folder.string()), job.done.size()));
    if (last) DARKROOM_TRY(check_arguments(work.folder, *last, job.arguments));
    if (last && !job.done.empty()) DARKROOM_TRY(check_inputs(work.folder, *last, job.inputs));
    const std::vector<std::string> chunks = chunks_of(work, job.done, chunk);
    if (chunks.empty()) {
        answer_unless_quiet(fmt::format("all {} pictures are there, nothing is submitted", job.frames.size()));
        return {};
    }
    // The records of a chunk are files of its name.
    constexpr std::size_t longest_name = 200;
    if (std::ranges::any_of(chunks, [](const std::string& name) { return name.size() > longest_name; }))
        return user_error(fmt::format(
            "--chunk {}: the frames of a chunk are too scattered for a file's name; choose a smaller number", chunk));
    if (chunks.size() > max_chunks)
        return user_error(fmt::format("--chunk {}: {} chunks, an array job holds {}: --chunk {} is enough", chunk,
                                      chunks.size(), max_chunks, (work.frames.size() + max_chunks - 1) / max_chunks));
    DARKROOM_TRY_VALUE(const std::string script, script_of(options, work, chunks));
    if (options.is_dry_run) {
        answer(script.substr(0, script.size() - 1));
        return {};
    }
    if (last) DARKROOM_TRY(check_is_over(work, *last));
    DARKROOM_TRY_VALUE(job.id, submit(work.folder, script));
    if (Result<> done = write_job(work.folder, job); !done)
        return darkroom::machine_error(fmt::format("job {} was submitted, but {}", job.id, done.error().text));
    answer_unless_quiet(fmt::format("job {}: {} of {} pictures in {} chunks; darkroom farm status {}", job.id,
                                    job.frames.size() - job.done.size(), job.frames.size(), chunks.size(),
                                    printable(work.folder.string())));
    return {};
}

}  // namespace

Command add_farm_slurm(CommandFlags farm, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command = farm.add_command("slurm", "Submits what is missing of a sequence as an array job");
    command.examples(
        "darkroom farm slurm 'shot.####.exr' --look my.toml -o . --chunk 1 --dry-run\n"
        "darkroom farm slurm 'shot.####.exr' -o bright/ --mkdir --partition gpu --time 30 --dry-run -- --exposure 2\n"
        "darkroom farm slurm scene.toml -o 'scene.####.png' --frames 0-99 --dry-run -- --size 64x36");
    const auto options = std::make_shared<SlurmOptions>();
    options->work.add_to(command, "Numbers of the frames: of a sequence those to make, of a scene all");
    const std::string group = "The job";
    options->chunk.add_to(command, "Frames of a task").type_name("N").default_str("10").group(group);
    command.add_option("--partition", options->partition, "Partition in which tasks run, as for sbatch")
        .type_name("NAME")
        .group(group);
    command.add_option("--time", options->time, "Longest time of a task, as for sbatch: minutes, or HH:MM:SS")
        .type_name("TIME")
        .group(group);
    command.add_option("--gpus", options->gpus, "GPUs of each task, as for sbatch: a number, or TYPE:N")
        .type_name("N")
        .group(group);
    command.add_option("--account", options->account, "Account that is charged, as for sbatch")
        .type_name("NAME")
        .group(group);
    options->cpus.add_to(command, "Processors of each task; default: Slurm's, which is 1").type_name("N").group(group);
    command
        .add_option("--program", options->program,
                    "Command that runs darkroom on a node, as a shell takes it; default: this program at its path here")
        .type_name("COMMAND")
        .group(group);
    command.add_flag("--dry-run", options->is_dry_run, "Prints the script, and submits nothing").group(group);
    return {command, [options, named] {
                const Result<> done = run(*options, named);
                return done ? exit_ok : fail(done.error());
            }};
}

}  // namespace app
