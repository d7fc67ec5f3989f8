// SPDX-License-Identifier: MIT
#include "farm_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/sequence.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;

namespace {

constexpr std::int64_t format = 1;
constexpr const char* job_file = "job.json";
// A hundred thousand frames with gaps, asked for and done, take 8 MB.
constexpr std::size_t max_bytes = std::size_t{16} << 20;
constexpr std::array<const char*, 3> state_names{"begun", "done", "failed"};

/// What is wrong with a file, thrown and caught in this one, as the parser's own errors are.
struct Wrong {
    std::string text;
};

const Json& member(const Json& json, const char* key, bool (Json::*is_kind)() const) {
    const Json* const found = json.find(key);
    if (found == nullptr) throw Wrong{fmt::format("{} is missing", key)};
    if (!(found->*is_kind)()) throw Wrong{fmt::format("{} is of another kind", key)};
    return *found;
}

std::string text_of(const Json& json, const char* key) { return member(json, key, &Json::is_text).text(); }

std::vector<std::string> texts_of(const Json& json, const char* key) {
    std::vector<std::string> out;
    for (const Json& text : member(json, key, &Json::is_array).elements()) {
        if (!text.is_text()) throw Wrong{fmt::format("{} are no texts", key)};
        out.push_back(text.text());
    }
    return out;
}

FrameNumbers numbers_of(const Json& json, const char* key) {
    FrameNumbers out;
    for (const Json& range : member(json, key, &Json::is_array).elements()) {
        if (!range.is_array() || range.size() != 2 || !std::ranges::all_of(range.elements(), &Json::is_whole))
            throw Wrong{fmt::format("{} are no pairs of frames", key)};
        const std::int64_t first = range.elements()[0].whole(), last = range.elements()[1].whole();
        const bool is_behind = out.empty() || first > *out.rbegin();
        if (std::abs(first) > darkroom::FrameSet::max_number || last < first || !is_behind ||
            static_cast<std::size_t>(last - first) >= max_frames - out.size())
            throw Wrong{fmt::format("{}: allowed are [first, last] in order, {} frames at most", key, max_frames)};
        for (std::int64_t number = first; number <= last; ++number) out.insert(out.end(), number);
    }
    return out;
}

FarmNames names_of(const Json& json) {
    return {.input = text_of(json, "input"),
            .output = text_of(json, "output"),
            .is_folder = member(json, "output_is_folder", &Json::is_boolean).boolean()};
}

void add_names(Json& json, const FarmNames& names) {
    json["input"] = names.input;
    json["output"] = names.output;
    json["output_is_folder"] = names.is_folder;
}

ChunkRecord record_of(const Json& json) {
    ChunkRecord out{.name = text_of(json, "chunk"),
                    .frames = numbers_of(json, "frames"),
                    .done = numbers_of(json, "done"),
                    .tries = member(json, "tries", &Json::is_whole).whole(),
                    .made = member(json, "made", &Json::is_whole).whole(),
                    .seconds = member(json, "seconds", &Json::is_number).number(),
                    .node = text_of(json, "node"),
                    .job = text_of(json, "job"),
                    .begun = text_of(json, "begun"),
                    .errors = texts_of(json, "errors")};
    const auto state = std::ranges::find(state_names, text_of(json, "state"));
    if (state == state_names.end()) throw Wrong{"state: allowed is begun, done or failed"};
    out.state = static_cast<ChunkState>(state - state_names.begin());
    out.names = names_of(json);
    return out;
}

FarmInputs inputs_of(const Json& json) {
    FarmInputs out;
    if (json.find("inputs") == nullptr) return out;
    for (const auto& [file, hash] : member(json, "inputs", &Json::is_object).members()) {
        if (!hash.is_text()) throw Wrong{"inputs are no texts"};
        out.emplace(file, hash.text());
    }
    return out;
}

FarmJob job_of(const Json& json) {
    return {.arguments = texts_of(json, "arguments"),
            .inputs = inputs_of(json),
            .names = names_of(json),
            .id = text_of(json, "job"),
            .frames = numbers_of(json, "frames"),
            .done = numbers_of(json, "done")};
}

template <typename Read>
auto read(const fs::path& path, Read read_from) -> Result<decltype(read_from(Json()))> {
    DARKROOM_TRY_VALUE(const auto bytes, darkroom::read_file(path, {.max_size = max_bytes}));
    std::string problem = "is not JSON";
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (const std::optional<Json> json = Json::parse(text)) try {
            const Json* const found = json->find("format");
            if (found == nullptr || !found->is_number() || found->number() != format)
                throw Wrong{fmt::format("allowed is format = {}", format)};
            return read_from(*json);
        } catch (const Wrong& wrong) {
            problem = wrong.text;
        }
    return darkroom::user_error(fmt::format("{}: {}", printable(path.string()), problem));
}

// Text that is no UTF-8, as names of files may be, is written with a sign in its place.
Result<> write(const fs::path& path, const Json& json) {
    const std::string text = json.dump(1) + "\n";
    return darkroom::write_own_file(path, std::as_bytes(std::span(text)), darkroom::FileOwner::Anyone);
}

Result<std::vector<fs::path>> record_files(const fs::path& folder) {
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".json" && entry->path().filename() != job_file) {
            out.push_back(entry->path());
            if (out.size() > max_frames)
                return darkroom::user_error(fmt::format("{}: holds more than {} records, no more are allowed",
                                                        printable(folder.string()), max_frames));
        }
    if (error)
        return darkroom::user_error(
            fmt::format("{}: cannot be listed: {}", printable(folder.string()), error.message()));
    std::ranges::sort(out);
    return out;
}

}  // namespace

fs::path job_path(const fs::path& folder) { return folder / job_file; }

Json json_of(const FrameNumbers& numbers) { return ranges_of(numbers); }

FrameNumbers without(const FrameNumbers& numbers, const FrameNumbers& others) {
    FrameNumbers out;
    std::ranges::set_difference(numbers, others, std::inserter(out, out.end()));
    return out;
}

std::vector<fs::path> FarmNames::pictures(long long number) const {
    std::vector<fs::path> out = darkroom::spellings(input, number);
    for (fs::path& path : out) path = output_path(path, number, output, is_folder);
    return out;
}

Json json_of(const ChunkRecord& record) {
    Json out{{"format", format},
             {"chunk", record.name},
             {"state", state_names[static_cast<std::size_t>(record.state)]},
             {"frames", json_of(record.frames)},
             {"done", json_of(record.done)},
             {"made", record.made},
             {"tries", record.tries},
             {"seconds", record.seconds},
             {"begun", record.begun},
             {"node", record.node},
             {"job", record.job},
             {"errors", record.errors}};
    add_names(out, record.names);
    return out;
}

// Text that is no UTF-8 is alike in both.
bool has_arguments(const FarmJob& job, const std::vector<std::string>& arguments) {
    return Json(job.arguments).dump() == Json(arguments).dump();
}

Result<> check_arguments(const fs::path& folder, const FarmJob& job, const std::vector<std::string>& now) {
    if (has_arguments(job, now)) return {};
    return darkroom::user_error(fmt::format(
        "{}: its pictures were made with other arguments ({}); remove it and its pictures, or write elsewhere with -o",
        printable(folder.string()), printable(fmt::format("{}", fmt::join(job.arguments, " ")))));
}

Result<> check_inputs(const fs::path& folder, const FarmJob& job, const FarmInputs& now) {
    if (job.inputs.empty()) return {};
    FarmInputs changed;  // those of one of the two that the other has not
    std::ranges::set_symmetric_difference(job.inputs, now, std::inserter(changed, changed.end()));
    if (changed.empty()) return {};
    const std::string since = job.id.empty() ? "its pictures were made" : fmt::format("job {} was submitted", job.id);
    return darkroom::user_error(
        fmt::format("{}: {} has changed since {}; remove its pictures, or write elsewhere with -o",
                    printable(folder.string()), changed.begin()->first, since));
}

Result<> write_job(const fs::path& folder, const FarmJob& job) {
    Json inputs = Json::object();
    for (const auto& [file, hash] : job.inputs) inputs[file] = hash;
    Json out{{"format", format},
             {"job", job.id},
             {"frames", json_of(job.frames)},
             {"done", json_of(job.done)},
             {"arguments", job.arguments},
             {"inputs", std::move(inputs)}};
    add_names(out, job.names);
    return write(job_path(folder), out);
}

Result<> write_record(const fs::path& folder, const ChunkRecord& record) {
    return write(folder / (record.name + ".json"), json_of(record));
}

Result<std::optional<FarmJob>> read_job(const fs::path& folder) {
    std::error_code error;
    const bool is_there = fs::exists(job_path(folder), error);
    if (error)
        return darkroom::machine_error(
            fmt::format("{}: cannot be opened: {}", printable((job_path(folder)).string()), error.message()));
    if (!is_there) return std::optional<FarmJob>();
    DARKROOM_TRY_VALUE(FarmJob job, read(job_path(folder), job_of));
    return std::optional<FarmJob>(std::move(job));
}

Result<std::vector<ChunkRecord>> read_records(const fs::path& folder) {
    DARKROOM_TRY_VALUE(const std::vector<fs::path> files, record_files(folder));
    std::vector<ChunkRecord> out;
    for (const fs::path& file : files) {
        Result<ChunkRecord> record = read(file, record_of);
        if (record)
            out.push_back(std::move(*record));
        else
            warn(record.error().text);
    }
    return out;
}

}  // namespace app
