// SPDX-License-Identifier: MIT
#include "outputs.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "image/picture/alpha.hpp"
#include "report.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

constexpr std::string_view name_pattern = "{name}";

std::optional<std::pair<std::uintmax_t, std::uintmax_t>> identity_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return std::pair<std::uintmax_t, std::uintmax_t>{status.st_dev, status.st_ino};
}

}  // namespace

bool FileSet::contains(const fs::path& file) const {
    const auto identity = identity_of(file);
    if (!identity) return false;
    for (const fs::path& name : std::exchange(names_, {}))
        if (const auto known = identity_of(name)) files_.insert(*known);
    return files_.contains(*identity);
}

bool is_there(const fs::path& picture) {
    std::error_code error;
    return fs::is_regular_file(picture, error) && fs::file_size(picture, error) > 0 && !error;
}

Result<> check_folder(const fs::path& folder, MissingFolders missing) {
    std::error_code error;
    if (folder.empty() || fs::is_directory(folder, error)) return {};
    if (missing != MissingFolders::Made)
        return user_error(fmt::format("{}: no such folder, nothing can be written there{}", printable(folder.string()),
                                      missing == MissingFolders::Told ? "; --mkdir makes it" : ""));
    fs::create_directories(folder, error);
    if (!error) return {};
    return user_error(fmt::format("{}: cannot be made: {}", printable(folder.string()), error.message()));
}

Result<> check_output(const fs::path& output, const FileSet& inputs, MissingFolders folders) {
    std::error_code error;
    if (inputs.contains(output))
        return user_error(fmt::format("{}: is also an input, and would be overwritten", printable(output.string())));
    DARKROOM_TRY(check_folder(output.parent_path(), folders));
    // Reserving the file tells now, before any work, whether it can be written.
    DARKROOM_TRY(darkroom::AtomicPath::beside(output));
    return {};
}

Result<> check_report(const fs::path& report, const FileSet& inputs, MissingFolders folders) {
    DARKROOM_TRY(darkroom::check_own_file(report, darkroom::FileOwner::Anyone));
    return darkroom::is_place_of_system(report) ? Result<>() : check_output(report, inputs, folders);
}

bool is_output_pattern(const std::string& out) {
    return darkroom::has_number_pattern(out) || out.find(name_pattern) != std::string::npos;
}

bool is_output_folder(const std::string& out, MissingFolders missing) {
    std::error_code error;
    if (out.ends_with('/') || fs::is_directory(out, error)) return true;
    return missing == MissingFolders::Made && !is_output_pattern(out) && !fs::path(out).has_extension() &&
           !fs::exists(out, error);
}

fs::path output_path(const fs::path& input, long long number, const std::string& out, bool is_folder) {
    if (is_folder) return fs::path(out) / fs::path(input.filename()).replace_extension(".png");
    std::string text = out;
    const std::string name = input.stem().string();
    for (std::size_t at = 0; (at = text.find(name_pattern, at)) != std::string::npos; at += name.size())
        text.replace(at, name_pattern.size(), name);
    return darkroom::has_number_pattern(out) ? darkroom::numbered(text, number) : fs::path(text);
}

Result<std::vector<fs::path>> output_paths(std::span<const darkroom::NumberedFile> inputs, const std::string& out,
                                           std::span<const fs::path> also_read,
                                           const std::function<bool(long long)>& is_asked_for, MissingFolders folders) {
    if (out.empty()) return user_error("-o: an output file is needed");
    const bool is_folder = is_output_folder(out, folders);
    if (is_folder) DARKROOM_TRY(check_folder(out, folders));
    const auto asked_for =
        std::ranges::count_if(inputs, [&](const darkroom::NumberedFile& input) { return is_asked_for(input.number); });
    if (asked_for > 1 && !is_folder && !is_output_pattern(out)) {
        // Such as a value behind a flag that takes none: --vignette 0.5.
        for (const darkroom::NumberedFile& input : inputs)
            if (std::error_code error; !fs::exists(input.path, error))
                return user_error(fmt::format("{}: there is no such file", printable(input.path.string())));
        return user_error(fmt::format(
            "-o {}: {} inputs need a folder (--mkdir makes a new one), or a name with %04d, #### or {{name}}",
            printable(out), asked_for));
    }
    std::vector<fs::path> outputs;
    std::map<fs::path, fs::path> makers;
    std::vector<fs::path> read(also_read.begin(), also_read.end());
    for (const darkroom::NumberedFile& input : inputs) read.push_back(input.path);
    const FileSet files(read);
    for (const auto& [input, number] : inputs) {
        fs::path path = output_path(input, number, out, is_folder);
        if (!is_asked_for(number)) {
            outputs.push_back(std::move(path));
            continue;
        }
        const auto [maker, is_new] = makers.try_emplace(path, input);
        if (!is_new)
            return user_error(fmt::format("{}: two inputs would be written to it, {} and {}", printable(path.string()),
                                          printable(maker->second.string()), printable(input.string())));
        DARKROOM_TRY(check_output(path, files, folders));
        outputs.push_back(std::move(path));
    }
    return outputs;
}

using darkroom::VideoFormat;

namespace {

Result<> write_all(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return darkroom::machine_error(fmt::format("standard output: {}", std::strerror(errno)));
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

}  // namespace

PictureStream::PictureStream(const StreamDesc& desc) : desc_(desc) {
    leave_standard_output();
    survive_closed_pipes();
}

std::vector<std::byte> PictureStream::pack(darkroom::DevelopedPicture picture) const {
    if (desc_.has_alpha_of_glow) darkroom::make_alpha_of_glow(picture.pixels);
    return desc_.format == VideoFormat::Rgba64le ? darkroom::video_frame_16(picture.pixels, desc_.has_alpha)
                                                 : darkroom::video_frame(desc_.format, picture.bytes);
}

Result<> PictureStream::write(std::span<const std::byte> packed, VkExtent2D extent, std::string_view name) {
    if (!extent_) {
        const std::string head = video_head(desc_.format, extent.width, extent.height, desc_.rate);
        DARKROOM_TRY(write_all(std::as_bytes(std::span(head))));
        extent_ = extent;
    }
    if (extent_->width != extent.width || extent_->height != extent.height)
        return darkroom::user_error(fmt::format("{}: {}x{}, the stream is {}x{}; --size makes them the same", name,
                                                extent.width, extent.height, extent_->width, extent_->height));
    return write_all(packed);
}

}  // namespace app
