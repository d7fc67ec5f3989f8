// SPDX-License-Identifier: MIT
#pragma once
// Which file each input becomes. OUT is a file for one input; for several it is a pattern with %04d or #### (the
// frame's number) or {name} (the input's name without extension), or a folder, where each becomes <name>.png.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "develop/developer.hpp"
#include "image/frame/sequence.hpp"
#include "image/picture/video_frame.hpp"
#include "image/picture/write.hpp"

namespace app {

/// Files as the machine knows them, whatever their names. They are looked at when a file that is there is asked for:
/// those of a long sequence are as many requests of a file server.
class FileSet {
  public:
    explicit FileSet(std::span<const std::filesystem::path> files) : names_(files.begin(), files.end()) {}
    [[nodiscard]] bool contains(const std::filesystem::path& file) const;

  private:
    mutable std::vector<std::filesystem::path> names_;                   ///< of those not looked at yet
    mutable std::set<std::pair<std::uintmax_t, std::uintmax_t>> files_;  ///< device and number
};

/// Is this picture made already? An empty file is none.
[[nodiscard]] bool is_there(const std::filesystem::path& picture);

enum class MissingFolders {
    Refused,  ///< by a command that makes none
    Told,     ///< refused, and told that --mkdir makes them
    Made
};

/// Is there a folder for pictures, or can there be one? An empty path is the working folder.
[[nodiscard]] darkroom::Result<> check_folder(const std::filesystem::path& folder, MissingFolders missing);

/// Can this file be written, and is it none of the inputs? Told before any work is done.
[[nodiscard]] darkroom::Result<> check_output(const std::filesystem::path& output, const FileSet& inputs,
                                              MissingFolders folders = MissingFolders::Refused);

/// The same of what is written beside the pictures: reports, frames. A link is refused, and so is what is no file.
[[nodiscard]] darkroom::Result<> check_report(const std::filesystem::path& report, const FileSet& inputs,
                                              MissingFolders folders = MissingFolders::Refused);

/// Does OUT name a folder? One that is to be made has no extension.
[[nodiscard]] bool is_output_folder(const std::string& out, MissingFolders missing);
/// What an input of this number becomes. Nothing is looked at.
[[nodiscard]] std::filesystem::path output_path(const std::filesystem::path& input, long long number,
                                                const std::string& out, bool is_folder);

/// One output for each input. Those of the inputs that are asked for are tried: a long sequence on a file server is
/// developed in many pieces. Errors: one file for several inputs, two inputs for one output, an output that is one of
/// the inputs or of what is `also_read`, a folder that does not exist, a name that cannot be written.
[[nodiscard]] darkroom::Result<std::vector<std::filesystem::path>> output_paths(
    std::span<const darkroom::NumberedFile> inputs, const std::string& out,
    std::span<const std::filesystem::path> also_read, const std::function<bool(long long number)>& is_asked_for,
    MissingFolders folders);

// Pictures through standard output into another program: what `-o -` means.

/// What stands for the output's name.
inline constexpr std::string_view stream_name = "-";

struct StreamDesc {
    darkroom::VideoFormat format = darkroom::VideoFormat::Y4m;
    darkroom::FrameRate rate;
    bool has_alpha = false, has_alpha_of_glow = false;  ///< as of WriteOptions
};

/// Pictures are packed by any thread, and written in their order by one at a time.
class PictureStream {
  public:
    /// Standard output is the stream's alone from here on, and a reader that ends is an error, not a signal.
    explicit PictureStream(const StreamDesc& desc);
    [[nodiscard]] std::vector<std::byte> pack(darkroom::DevelopedPicture picture) const;
    /// Errors: the picture has another size than the first, in the words of `name`; nobody reads any more.
    [[nodiscard]] darkroom::Result<> write(std::span<const std::byte> packed, VkExtent2D extent, std::string_view name);

  private:
    StreamDesc desc_;
    std::optional<VkExtent2D> extent_;
};

}  // namespace app
