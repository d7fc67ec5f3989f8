// SPDX-License-Identifier: MIT
#pragma once
// Fuzzers: functions that take any bytes, hand them to one reader of the tree, and say where a promise was broken. A
// file NAME_fuzz.cpp has the target NAME. Built with clang, bin/fuzz_NAME is libFuzzer's program of it (main.cpp);
// darkroom_tests runs every target once, over its seeds and the cases that were kept (fuzz_test.cpp).

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::fuzz {

struct Target {
    std::string_view name;
    /// What is wrong; empty: nothing. What ends the process is wrong, too.
    std::string (*run)(std::string_view input);
    /// Inputs to begin with.
    std::vector<std::string> (*seeds)();
    std::size_t longest = 4096;      ///< bytes of an input
    std::size_t max_mebibytes = 64;  ///< of one allocation
};

/// All targets that are linked.
[[nodiscard]] std::vector<Target>& targets();
/// One of namespace scope adds its target to them.
struct Registration {
    explicit Registration(const Target& target) { targets().push_back(target); }
};

/// What the files that match hold: `pattern` is a folder of the tree, or of the test data (data/...), and the end of a
/// name: "looks/*.toml". Those without the test data are none.
[[nodiscard]] std::vector<std::string> files(std::string_view pattern);

/// What is wrong with an error that an input of bytes alone may have: it is the user's, and one line that can be
/// printed.
[[nodiscard]] std::string wrong_error(const Error& error);
/// The same of a warning.
[[nodiscard]] std::string wrong_line(std::string_view line);

/// Bytes as a file that is in no folder, for readers that want a path.
class MemoryFile {
  public:
    explicit MemoryFile(std::string_view content);
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile();
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    int number_ = -1;
    std::filesystem::path path_;
};

[[nodiscard]] inline std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

}  // namespace darkroom::fuzz
