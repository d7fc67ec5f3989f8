// SPDX-License-Identifier: MIT
#pragma once
// Which file each input becomes. OUT is a file for one input; for several it is a pattern with %04d or #### (the
// frame's number) or {name} (the input's name without extension), or a folder, where each becomes <name>.png.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace app {

/// Files as the machine knows them, whatever their names.
class FileSet {
  public:
    explicit FileSet(std::span<const std::filesystem::path> files);
    [[nodiscard]] bool contains(const std::filesystem::path& file) const;

  private:
    std::set<std::pair<std::uintmax_t, std::uintmax_t>> files_;  ///< device and number
};

/// Can this file be written, and is it none of the inputs? Told before any work is done.
[[nodiscard]] darkroom::Result<> check_output(const std::filesystem::path& output, const FileSet& inputs);

/// The frames' own numbers where all have one and no two the same, else 1, 2, 3.
[[nodiscard]] std::vector<long long> numbers_of(std::span<const std::filesystem::path> inputs);

/// One output for each input. Errors: one file for several inputs, two inputs for one output, an output that is one of
/// the inputs or of what is `also_read`, a folder that does not exist, a name that cannot be written.
[[nodiscard]] darkroom::Result<std::vector<std::filesystem::path>> output_paths(
    std::span<const std::filesystem::path> inputs, const std::string& out,
    std::span<const std::filesystem::path> also_read);

}  // namespace app
