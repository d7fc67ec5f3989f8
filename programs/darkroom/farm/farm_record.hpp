// SPDX-License-Identifier: MIT
#pragma once
// What a farm remembers, as small files of JSON in a folder beside the pictures, "NAME.farm": job.json is what was
// submitted last, A-B.json what became of a chunk. Each has one writer at a time and is replaced whole, so tasks share
// no file and need no lock.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/json.hpp"

namespace app {

inline constexpr const char* farm_suffix = ".farm";

/// [[0, 6], [9, 9]]
[[nodiscard]] Json json_of(const FrameNumbers& numbers);
[[nodiscard]] FrameNumbers without(const FrameNumbers& numbers, const FrameNumbers& others);

/// The files that pictures are made of beside the frames, and the hashes of their contents.
using FarmInputs = std::map<std::string, std::string>;

/// What the pictures of a farm are called, as the farm was asked.
struct FarmNames {
    std::string input, output;
    bool is_folder = false;  ///< the output is one

    /// One for each name that its input may have; of the usual one first.
    [[nodiscard]] std::vector<std::filesystem::path> pictures(long long number) const;
};

struct FarmJob {
    std::vector<std::string> arguments;  ///< of each task, but for its frames
    FarmInputs inputs;                   ///< empty: nobody knows
    FarmNames names;
    std::string id;       ///< Slurm's; empty: of tasks that something else started
    FrameNumbers frames;  ///< all that are asked for
    FrameNumbers done;    ///< those whose pictures were there when it was submitted
};

/// In the words of the file.
enum class ChunkState { begun, done, failed };

struct ChunkRecord {
    std::string name;  ///< "A-B", as the task was asked
    FarmNames names;
    FrameNumbers frames, done;             ///< those that there are, those whose pictures are there
    ChunkState state = ChunkState::begun;  ///< one that was killed has begun
    std::int64_t tries = 0, made = 0;      ///< made: pictures that were not there before
    double seconds = 0;
    std::string node, job, begun;
    std::vector<std::string> errors;  ///< of the last try
};

[[nodiscard]] Json json_of(const ChunkRecord& record);
/// Of what was submitted, in the folder of records.
[[nodiscard]] std::filesystem::path job_path(const std::filesystem::path& folder);
[[nodiscard]] darkroom::Result<> write_job(const std::filesystem::path& folder, const FarmJob& job);
[[nodiscard]] darkroom::Result<> write_record(const std::filesystem::path& folder, const ChunkRecord& record);
/// Of another job: the arguments are the same, as far as a file of JSON has them.
[[nodiscard]] bool has_arguments(const FarmJob& job, const std::vector<std::string>& arguments);
[[nodiscard]] darkroom::Result<> check_arguments(const std::filesystem::path& folder, const FarmJob& job,
                                                 const std::vector<std::string>& now);
/// The error names the folder, and the first file that is another one now.
[[nodiscard]] darkroom::Result<> check_inputs(const std::filesystem::path& folder, const FarmJob& job,
                                              const FarmInputs& now);
/// Nothing where none was submitted.
[[nodiscard]] darkroom::Result<std::optional<FarmJob>> read_job(const std::filesystem::path& folder);
/// In the order of their names. A file that is no record is a warning, and counts for nothing.
[[nodiscard]] darkroom::Result<std::vector<ChunkRecord>> read_records(const std::filesystem::path& folder);

}  // namespace app
