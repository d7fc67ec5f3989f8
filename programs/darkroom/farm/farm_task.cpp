// SPDX-License-Identifier: MIT
// darkroom farm task: what a machine of a farm does: one chunk, tried again where it fails, and a record of it.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

#include "confined/process.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "farm.hpp"
#include "farm_process.hpp"
#include "programs/darkroom/flags/program.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;

namespace {

constexpr std::int64_t max_tries = 4;  // the first, and three more
constexpr std::chrono::seconds pause{1};

std::string node_name() {
    std::array<char, 256> name{};
    const char* const slurm = std::getenv("SLURMD_NODENAME");
    if (slurm != nullptr) return slurm;
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// "17_3": the job and its task.
std::string job_name() {
    const char *const job = std::getenv("SLURM_ARRAY_JOB_ID"), *const task = std::getenv("SLURM_ARRAY_TASK_ID");
    return job != nullptr && task != nullptr ? fmt::format("{}_{}", job, task) : "";
}

FrameNumbers numbers_there(const FarmWork& work) {
    FrameNumbers out;
    for (const FarmFrame& frame : work.frames)
        if (is_there(frame.picture)) out.insert(frame.number);
    return out;
}

class Task {
  public:
    Task(const FarmFlags& flags, FarmWork work) : flags_(flags), work_(std::move(work)) {}

    Result<int> run() {
        DARKROOM_TRY(begin());
        if (is_done())
            tell(fmt::format("{} of {} pictures are there already", record_.done.size(), record_.frames.size()));
        while (!is_done() && record_.tries < max_tries) {
            if (record_.tries > 0) std::this_thread::sleep_for(pause);
            ++record_.tries;
            DARKROOM_TRY(try_once());
        }
        record_.state = is_done() ? ChunkState::done : ChunkState::failed;
        if (!is_written_) DARKROOM_TRY(write());
        if (is_done()) return exit_ok;
        const FrameNumbers left = without(record_.frames, record_.done);
        complain(fmt::format("{} {} failed in {} tries: {}", left.size() == 1 ? "frame" : "frames", shown(left),
                             record_.tries, printable((work_.folder / (record_.name + ".json")).string())));
        return code_;
    }

  private:
    [[nodiscard]] bool is_done() const { return record_.done.size() == record_.frames.size(); }

    Result<> begin() {
        DARKROOM_TRY(darkroom::make_own_folder(work_.folder));
        DARKROOM_TRY_VALUE(const darkroom::FrameSet frames, parse_frames(flags_.frames()));
        const std::vector<long long> numbers = frames.numbers();
        record_.name = frames.is_range() ? fmt::format("{}-{}", numbers.front(), numbers.back())
                                         : darkroom::frame_set_text(numbers);
        record_.names = work_.names;
        record_.node = node_name();
        record_.job = job_name();
        record_.begun = fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
        for (const FarmFrame& frame : work_.frames) record_.frames.insert(frame.number);
        record_.done = numbers_there(work_);
        there_before_ = record_.done.size();
        // What an earlier run did stays written where nothing is left to do.
        if (is_done()) {
            DARKROOM_TRY_VALUE(const std::vector<ChunkRecord> records, read_records(work_.folder));
            const auto before = std::ranges::find(records, record_.name, &ChunkRecord::name);
            if (before != records.end() && before->state == ChunkState::done) {
                is_written_ = true;
                return {};
            }
        }
        return write();
    }

    Result<> try_once() {
        std::error_code error;
        std::vector<std::string> arguments{fs::read_symlink("/proc/self/exe", error).string()};
        for (std::string& argument : flags_.command(flags_.frames())) arguments.push_back(std::move(argument));
        if (current_voice() != Voice::Usual) arguments.emplace_back(current_voice() == Voice::Quiet ? "-q" : "-v");
        if (darkroom::ConfinedProcess::allows_unconfined()) arguments.emplace_back("--allow-unconfined");
        // Where this process is killed, nobody sends a signal on: that one asks to get it.
        ::setenv(task_of_farm, std::to_string(::getpid()).c_str(), 1);
        DARKROOM_TRY_VALUE(const ProcessOutcome outcome, run_process(arguments, ProcessOutput::Told));
        record_.done = numbers_there(work_);
        record_.errors = outcome.errors;
        if (outcome.code > 128) record_.errors.push_back(fmt::format("ended by signal {}", outcome.code - 128));
        code_ = outcome.code == exit_user ? exit_user : exit_machine;
        return write();
    }

    Result<> write() {
        record_.made = static_cast<std::int64_t>(record_.done.size() - std::min(there_before_, record_.done.size()));
        record_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        return write_record(work_.folder, record_);
    }

    const FarmFlags& flags_;
    FarmWork work_;
    ChunkRecord record_;
    std::size_t there_before_ = 0;
    bool is_written_ = false;  ///< by an earlier run, which did all
    int code_ = exit_machine;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Of any task: one that was killed leaves whole pictures that it could not write down.
Result<bool> has_pictures(const fs::path& folder) {
    DARKROOM_TRY_VALUE(const std::vector<ChunkRecord> records, read_records(folder));
    return std::ranges::any_of(records, [&](const ChunkRecord& record) {
        return std::ranges::any_of(record.frames, [&](long long number) {
            return std::ranges::any_of(record.names.pictures(number), [&](const fs::path& picture) {
                return is_there(folder.parent_path() / picture.filename());
            });
        });
    });
}

/// What a job of these arguments was submitted with must be what its tasks read. Where nothing was submitted, the first
/// task writes what the others are held against, as long as a picture of theirs is there.
Result<> check_job(const FarmFlags& flags, const FarmWork& work, std::span<const darkroom::LookEntry> named) {
    DARKROOM_TRY_VALUE(std::optional<FarmJob> job, read_job(work.folder));
    if (!job && job_name().empty()) {
        // Those of another task that has just begun have its job beside them by now.
        const Result<> unknown = check_unknown_pictures(work);
        if (!unknown) {
            DARKROOM_TRY_VALUE(job, read_job(work.folder));
            if (!job) return unknown;
        }
    }
    // `farm slurm` writes it when the job is in the queue, where a task may begin before.
    if (!job && !job_name().empty()) return {};
    const bool is_submitted = job && !job->id.empty();
    if (is_submitted && !has_arguments(*job, flags.task())) return {};
    DARKROOM_TRY_VALUE(FarmInputs inputs, flags.check(work, named));
    if (is_submitted) return check_inputs(work.folder, *job, inputs);
    if (job) {
        Result<> same = check_arguments(work.folder, *job, flags.task());
        if (same) same = check_inputs(work.folder, *job, inputs);
        if (same) return {};
        DARKROOM_TRY_VALUE(const bool stays, has_pictures(work.folder));
        if (stays) return same;
    }
    DARKROOM_TRY(darkroom::make_own_folder(work.folder));
    return write_job(work.folder, {.arguments = flags.task(), .inputs = std::move(inputs), .names = work.names});
}

int run(const FarmFlags& flags, std::span<const darkroom::LookEntry> named) {
    if (flags.frames().empty()) return fail_user("farm task: --frames A-B is needed");
    Result<FarmWork> work = flags.work();
    if (!work) return fail(work.error());
    if (const Result<> done = check_job(flags, *work, named); !done) return fail(done.error());
    const Result<int> code = Task(flags, std::move(*work)).run();
    return code ? *code : fail(code.error());
}

}  // namespace

Command add_farm_task(CommandFlags farm, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command =
        farm.add_command("task", "Makes one chunk, tried again three times at most, and writes a record of it");
    command.examples(
        "darkroom farm task 'shot.####.exr' --look my.toml -o . --frames 1-1\n"
        "darkroom farm task 'shot.####.exr' -o bright/ --mkdir --frames 1-2 -- --exposure 2\n"
        "darkroom farm task scene.toml -o 'scene.####.png' --frames 0-1 -- --size 64x36");
    const auto flags = std::make_shared<FarmFlags>();
    flags->add_to(command, "The chunk");
    return {command, [flags, named] { return run(*flags, named); }};
}

}  // namespace app
