// SPDX-License-Identifier: MIT
// darkroom farm status: what is done, by the records beside the pictures alone.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/darkroom/run/report.hpp"
#include "core/text/param_text.hpp"
#include "farm.hpp"
#include "farm_record.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;

namespace {

struct StatusOptions {
    std::string folder;
    bool is_json = false;
};

/// Each frame is in one of the three: a record that says done goes before one that says failed.
struct Status {
    std::string folder, job;
    FrameNumbers frames, done, failed, missing;
    std::vector<ChunkRecord> chunks;
};

Result<Status> status_of(const fs::path& folder) {
    Result<std::optional<FarmJob>> job = read_job(folder);
    if (!job) return failure(std::move(job));
    Result<std::vector<ChunkRecord>> records = read_records(folder);
    if (!records) return failure(std::move(records));
    Status out{.folder = folder.string(), .chunks = std::move(*records)};
    if (*job) {
        out.job = (*job)->id;
        out.frames = (*job)->frames;
        out.done = (*job)->done;
    }
    // What tasks of an earlier job did stands in `done`, unless its picture was taken away since.
    if (!out.job.empty())
        std::erase_if(out.chunks, [&](const ChunkRecord& record) {
            return !record.job.empty() && !record.job.starts_with(out.job + "_");
        });
    FrameNumbers failed;
    for (const ChunkRecord& record : out.chunks) {
        out.frames.insert(record.frames.begin(), record.frames.end());
        out.done.insert(record.done.begin(), record.done.end());
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
    answer(fmt::format("{}: {} frames: {} done, {} failed, {} missing", printable(status.folder), status.frames.size(),
                       status.done.size(), status.failed.size(), status.missing.size()));
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
        answer(fmt::format("  {} pictures in {:.1f} s of tasks, {:.2f} s each", made, seconds,
                           seconds / static_cast<double>(made)));
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

Result<> run(const StatusOptions& options) {
    const Result<std::vector<fs::path>> folders = folders_in(options.folder);
    if (!folders) return failure(folders.error());
    Json documents = Json::array();
    for (const fs::path& folder : *folders) {
        const Result<Status> status = status_of(folder);
        if (!status) return failure(status.error());
        if (options.is_json)
            documents.push_back(document_of(*status));
        else
            print(*status);
    }
    if (options.is_json) answer((documents.size() == 1 ? documents.elements().front() : documents).dump(1));
    return {};
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
                const Result<> done = run(*options);
                return done ? exit_ok : fail(done.error());
            }};
}

}  // namespace app
