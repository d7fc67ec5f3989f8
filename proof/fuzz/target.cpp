// SPDX-License-Identifier: MIT
#include "fuzz/target.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/text/param_text.hpp"
#include "tests/places.hpp"

namespace darkroom::fuzz {
namespace {

constexpr std::uintmax_t max_seed_bytes = 65536;

}  // namespace

std::vector<Target>& targets() {
    static std::vector<Target> all;
    return all;
}

std::vector<std::string> files(std::string_view pattern) {
    const std::size_t star = pattern.find('*');
    std::filesystem::path folder = std::filesystem::path(test::source_folder) / pattern.substr(0, star);
    if (pattern.starts_with("data/")) {
        const char* const data = std::getenv("DARKROOM_TEST_DATA");
        if (data == nullptr) return {};
        folder = std::filesystem::path(data) / pattern.substr(5, star - 5);
    }
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        if (entry->is_regular_file(error) && entry->file_size(error) <= max_seed_bytes &&
            entry->path().string().ends_with(pattern.substr(star + 1)))
            found.push_back(entry->path());
    std::ranges::sort(found);
    std::vector<std::string> out;
    for (const std::filesystem::path& path : found) {
        std::ifstream file(path, std::ios::binary);
        out.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return out;
}

std::string wrong_line(std::string_view line) {
    if (line.empty()) return "a message is empty";
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
    if (std::ranges::any_of(line, is_control)) return fmt::format("a message has control bytes: {}", printable(line));
    return {};
}

std::string wrong_error(const Error& error) {
    if (error.fault != Fault::User) return fmt::format("an input is the machine's fault: {}", error.text);
    return wrong_line(error.text);
}

MemoryFile::MemoryFile(std::string_view content) : number_(memfd_create("fuzz", MFD_CLOEXEC)) {
    path_ = fmt::format("/proc/self/fd/{}", number_);
    while (!content.empty()) {
        const ssize_t written = write(number_, content.data(), content.size());
        if (written <= 0) std::abort();
        content.remove_prefix(static_cast<std::size_t>(written));
    }
}

MemoryFile::~MemoryFile() { close(number_); }

}  // namespace darkroom::fuzz
