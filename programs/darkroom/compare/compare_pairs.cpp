// SPDX-License-Identifier: MIT
#include "compare_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <system_error>

#include "core/text/param_text.hpp"
#include "image/frame/frame_set.hpp"
#include "image/frame/sequence.hpp"
#include "image/picture/write.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

enum class Side { File, Folder, Sequence };

Side side_of(const std::string& name) {
    std::error_code ignored;
    if (fs::is_directory(name, ignored)) return Side::Folder;
    return darkroom::has_number_pattern(name) && !fs::exists(name, ignored) ? Side::Sequence : Side::File;
}

std::string_view name_of(Side side) {
    constexpr std::array<std::string_view, 3> names{"a file", "a folder", "a sequence"};
    return names[static_cast<std::size_t>(side)];
}

/// Files by what pairs them.
using Files = std::map<std::string, fs::path>;

Result<Files> files_of_folder(const fs::path& folder) {
    Files files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored) && darkroom::written_format(entry->path()))
            files.emplace(entry->path().filename().string(), entry->path());
    }
    if (error)
        return user_error(fmt::format("{}: cannot list the folder: {}", printable(folder.string()), error.message()));
    return files;
}

Result<Files> files_of_sequence(const std::string& input) {
    DARKROOM_TRY_VALUE(const std::vector<darkroom::NumberedFile> found, darkroom::expand_inputs({&input, 1}));
    Files files;
    // In the order of their numbers, whatever their signs.
    for (const auto& [path, number] : found)
        files.emplace(fmt::format("{:020}", number + darkroom::FrameSet::max_number), path);
    return files;
}

}  // namespace

Result<FilePairs> find_pairs(const std::string& reference, const std::string& test) {
    for (const std::string& name : {reference, test})
        if (std::error_code error; !fs::exists(name, error) && !darkroom::has_number_pattern(name))
            return user_error(fmt::format("{}: there is no such file or folder", printable(name)));
    const Side side = side_of(reference), other = side_of(test);
    if (side != other)
        return user_error(fmt::format("{} is {} and {} is {}: two files, two folders or two sequences are needed",
                                      printable(reference), name_of(side), printable(test), name_of(other)));
    FilePairs out;
    if (side == Side::File) {
        out.is_single = true;
        out.pairs.push_back({reference, test});
        return out;
    }
    const auto files_of = [&](const std::string& name) {
        return side == Side::Folder ? files_of_folder(name) : files_of_sequence(name);
    };
    DARKROOM_TRY_VALUE(const Files a, files_of(reference));
    DARKROOM_TRY_VALUE(const Files b, files_of(test));
    if (a.empty() && b.empty())
        return user_error(fmt::format("{} and {}: no pictures in either", printable(reference), printable(test)));
    for (const auto& [key, path] : a) {
        if (const auto found = b.find(key); found != b.end())
            out.pairs.push_back({path, found->second});
        else
            out.only_in_reference.push_back(path);
    }
    for (const auto& [key, path] : b)
        if (!a.contains(key)) out.only_in_test.push_back(path);
    return out;
}

}  // namespace app
