// SPDX-License-Identifier: MIT
#pragma once
// What the file of a custom effect says, as data that an EffectInfo refers to, and the passes that it is built from.
// The readers' errors begin with the thing; who knows the line puts the place in front.

#include <darkroom/effect.hpp>
#include <darkroom/result.hpp>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::custom {

// Beyond all that a picture needs, and within what a kernel may bind where every image is bound twice.
inline constexpr std::size_t most_images = 16, most_passes = 32, most_inputs = 8, most_parameters = 64;
inline constexpr std::size_t most_table_texels = 4096;
inline constexpr std::uint32_t most_pre_roll = 1000;

/// An image that the file declares.
struct FileImage {
    enum class Kind : std::uint8_t { Image, History, Table };
    std::string_view name;
    Kind kind = Kind::Image;
    VkFormat format = VK_FORMAT_UNDEFINED;
    OutputScale ratio;
    TableDesc table;
    std::size_t line = 0;
    bool is_written = false;
};

struct FileInput {
    std::string_view name;
    bool is_loaded = false;  ///< its function reads it by load() alone
};

/// A pass; or the end of the effect, which has neither name nor output.
struct FileFunction {
    std::string_view name, output;
    std::string_view shader;  ///< in EffectInfo::files
    std::vector<FileInput> inputs;
    std::size_t line = 0;
    bool reads_light = false;
};

/// Strings and choices are in deques, because others hold views of the elements while more are added.
struct Description {
    std::deque<std::string> strings;
    std::deque<std::vector<std::string_view>> choices;
    std::vector<ParamInfo> rows;
    std::vector<std::uint32_t> defaults;
    std::vector<EffectFile> files;
    std::vector<FileImage> images;
    std::vector<FileFunction> passes;
    std::optional<FileFunction> end;
    std::string_view result;
    std::optional<std::uint32_t> pre_roll;
    EffectInfo info;

    std::string_view keep(std::string_view text) { return strings.emplace_back(text); }
    /// Null: no image of the file has this name.
    [[nodiscard]] FileImage* find_image(std::string_view name);
};

/// A name for an effect, a parameter, an image or a pass.
[[nodiscard]] Result<> check_name(std::string_view name);
/// Splits "HEAD: REST".
struct Halves {
    std::string_view head, rest;
};
/// "HEAD: Sentence."
[[nodiscard]] Result<Halves> with_sentence(std::string_view text);

// The rest of a line behind its word.
[[nodiscard]] Result<> read_parameter(Description& out, std::string_view text);
[[nodiscard]] Result<> read_image(Description& out, FileImage::Kind kind, std::string_view text);
[[nodiscard]] Result<> read_result(Description& out, std::string_view text);
[[nodiscard]] Result<> read_pre_roll(Description& out, std::string_view text);
[[nodiscard]] Result<FileFunction> read_pass(Description& out, std::string_view text);
[[nodiscard]] Result<FileFunction> read_end(Description& out, std::string_view text);
/// What holds of the whole once every line was read.
[[nodiscard]] Result<> check_passes(Description& out);

/// Adds the images of the frame that `code`, the function's own, names, and says which images are loaded alone.
[[nodiscard]] Result<> read_uses(const Description& from, FileFunction& function, std::string_view code);
/// Files define functions, structs and constants; the kernels around them declare what they read and write. Returns the
/// text with the values of its `#define`s in place, line by line: a macro would reach the effects of the same kernel.
[[nodiscard]] Result<std::string> expand_code(std::string_view text, std::size_t& line);

/// The whole file; errors read "shown_name:line: ...".
[[nodiscard]] Result<> read_description(Description& out, std::string_view text, std::string_view shown_name);

void build(PassBuilder& builder, const Description& description);

}  // namespace darkroom::custom
