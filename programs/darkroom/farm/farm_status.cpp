// SPDX-License-Identifier: MIT
// darkroom farm status: what is done, by the records and by the pictures beside them: a task that was killed leaves
// whole ones that it could not write down.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "core/text/param_text.hpp"
#include "farm_record.hpp"
#include "programs/darkroom/farm/farm.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;

namespace {

struct StatusOptions {
    std::string folder;
    bool is_json = false;
};

/// Some pictures are not there.
constexpr int exit_incomplete = 3;

/// Each frame is in one of the three: a picture that is there goes before a record that says failed.
struct Status {
    std::string folder, job;
    FrameNumbers frames, done, failed, missing;
    std::vector<ChunkRecord> chunks;
};

std::set<std::string> files_beside(const fs::path& folder) {
    std::set<std::string> out;
    std::error_code error;
    const fs::path pictures = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
    for (fs::directory_iterator entry(pictures, error), end; !error && entry != end; entry.increment(error))
        out.insert(entry->path().filename().string());
    return out;
}

/// Those frames whose pictures are there and not empty, whoever wrote them down: a file server may have lost one since.
FrameNumbers numbers_there(const fs::path& folder, const std::set<std::string>& files, const FarmNames& names,
                           const FrameNumbers& frames) {
    FrameNumbers out;
    for (const long long number : frames) {
        const bool is_made = std::ranges::any_of(names.pictures(number), [&](const fs::path& picture) {
            const fs::path name = picture.filename();
            return files.contains(name.string()) && is_there(folder.parent_path() / name);
        });
        if (is_made) out.insert(out.end(), number);
    }
    return out;
}

Result<Status> status_of(const fs::path& folder) {
    DARKROOM_TRY_VALUE(std::optional<FarmJob> job, read_job(folder));
    DARKROOM_TRY_VALUE(std::vector<ChunkRecord> records, read_records(folder));
    Status out{.folder = folder.string(), .chunks = std::move(records)};
    const std::set<std::string> files = files_beside(folder);
    if (job) {
        out.job = job->id;
        out.frames = job->frames;
        out.done = numbers_there(folder, files, job->names, out.frames);
    }
    // What tasks of an earlier job said of themselves is not what this one is about.
    if (!out.job.empty())
        std::erase_if(out.chunks, [&](const ChunkRecord& record) {
            return !record.job.empty() && !record.job.starts_with(out.job + "_");
        });
    FrameNumbers failed;
    for (const ChunkRecord& record : out.chunks) {
        out.frames.insert(record.frames.begin(), record.frames.end());
        out.done.merge(numbers_there(folder, files, record.names, record.frames));
        if (record.state == ChunkState::failed) failed.insert(record.frames.begin(), record.frames.end());
    }
    out.failed = without(failed, out.done);
    out.missing = without(without(out.frames, out.done), out.failed);
    return out;
}

Json document_of(const Status& status) {
    Json chunks = Json::array();
    for (const ChunkRecord& record : status.chunks) chunks.push_back(json_of(record));
    return {{"folder", status.folder},          {"job", status.job},
            {"frames", json_of(status.frames)}, {"done", json_of(status.done)},
            {"failed", json_of(status.failed)}, {"missing", json_of(status.missing)},
            {"chunks", std::move(chunks)}};
}

void print(const Status& status) {
    answer(fmt::format("{}: {} frame{}: {} done, {} failed, {} missing", printable(status.folder), status.frames.size(),
                       status.frames.size() == 1 ? "" : "s", status.done.size(), status.failed.size(),
                       status.missing.size()));
    double seconds = 0;
    std::int64_t made = 0;
    for (const ChunkRecord& record : status.chunks) {
        seconds += record.seconds;
        made += record.made;
        const FrameNumbers left = without(record.frames, status.done);
        if (left.empty()) continue;
        if (record.state == ChunkState::failed)
            answer(fmt::format("  failed: {} on {}, {} tries: {}", shown(left), printable(record.node), record.tries,
                               record.errors.empty() ? "no reason given" : printable(record.errors.front())));
        if (record.state == ChunkState::begun)
            answer(fmt::format("  begun: {} on {} at {}, not ended", shown(left), printable(record.node),
                               printable(record.begun)));
    }
    if (!status.missing.empty()) answer(fmt::format("  missing: {}", shown(status.missing)));
    if (made > 0)
        answer(fmt::format("  {} picture{} in {:.1f} s of task time, {:.2f} s each", made, made == 1 ? "" : "s",
                           seconds, seconds / static_cast<double>(made)));
}

/// The folder itself, or all those in it.
Result<std::vector<fs::path>> folders_in(fs::path folder) {
    std::error_code error;
    if (!folder.has_filename()) folder = folder.parent_path();
    if (folder.extension() == farm_suffix) return std::vector{folder};
    std::vector<fs::path> out;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == farm_suffix && entry->is_directory(error))
            out.push_back(folder == "." ? entry->path().filename() : entry->path());
    if (error)
        return darkroom::user_error(
            fmt::format("{}: cannot be listed: {}", printable(folder.string()), error.message()));
    if (out.empty())
        return darkroom::user_error(fmt::format("{}: holds no folder NAME{}, so nothing was submitted from it",
                                                printable(folder.string()), farm_suffix));
    std::ranges::sort(out);
    return out;
}

/// Gives the exit code.
Result<int> run(const StatusOptions& options) {
    DARKROOM_TRY_VALUE(const std::vector<fs::path> folders, folders_in(options.folder));
    Json documents = Json::array();
    int code = exit_ok;
    for (const fs::path& folder : folders) {
        DARKROOM_TRY_VALUE(const Status status, status_of(folder));
        if (status.done.size() < status.frames.size()) code = exit_incomplete;
        if (options.is_json)
            documents.push_back(document_of(status));
        else
            print(status);
    }
    if (options.is_json) answer((documents.size() == 1 ? documents.elements().front() : documents).dump(1));
    return code;
}

}  // namespace

Command add_farm_status(CommandFlags farm) {
    const CommandFlags command = farm.add_command("status", "Tells what is done, failed and missing");
    command.examples(
        "darkroom farm status .\n"
        "darkroom farm status shot.farm\n"
        "darkroom farm status shot.farm --json");
    const auto options = std::make_shared<StatusOptions>();
    command.add_option("FOLDER", options->folder, "Folder of the pictures, or NAME.farm in it").required();
    command.add_flag("--json", options->is_json, "One document for programs");
    return {command, [options] {
                const Result<int> code = run(*options);
                return code ? *code : fail(code.error());
            }};
}

}  // namespace app
