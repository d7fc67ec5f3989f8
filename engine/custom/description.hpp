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
inline constexpr std::size_t max_images = 16, max_passes = 32, max_inputs = 8, max_parameters = 64;
inline constexpr std::size_t max_table_texels = 4096;
// What Vulkan promises of compute shaders, so that a file runs wherever the library does; and what a pass may write.
inline constexpr std::uint32_t max_invocations = 128, max_shared_bytes = 16384;
inline constexpr std::size_t max_outputs = 4, max_buffers = 4;
inline constexpr std::uint32_t max_numbers = 4096;
inline constexpr std::uint32_t max_pre_roll = 1000;

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

/// Numbers that compute passes write: of one frame, or a value, which lasts and every function may read.
struct FileBuffer {
    std::string_view name;
    bool is_value = false;
    std::string_view type = "float";
    std::uint32_t element_bytes = 4, count = 1;
    bool is_written = false;
};

struct FileBufferUse {
    std::string_view name;
    ComputePassDesc::Access access = ComputePassDesc::Access::Read;
};

/// A pass; or the end of the effect, which has neither name nor outputs.
struct FileFunction {
    std::string_view name;
    std::vector<std::string_view> outputs{};
    std::string_view shader{};  ///< in EffectInfo::files
    std::vector<std::string_view> inputs{};
    std::vector<FileBufferUse> buffers{};
    std::size_t line = 0;
    bool reads_light = false;
    bool is_compute = false;
    std::array<std::uint32_t, 2> workgroup{}, groups{};
    std::uint32_t shared_bytes = 0;
};

/// Strings and choices are in deques, because others hold views of the elements while more are added.
struct Description {
    std::deque<std::string> strings;
    std::deque<std::vector<std::string_view>> choices;
    std::vector<ParamInfo> rows;
    std::vector<std::uint32_t> defaults;
    std::vector<EffectFile> files;
    std::vector<FileImage> images;
    std::vector<FileBuffer> buffers;
    std::vector<FileFunction> passes;
    std::optional<FileFunction> end;
    std::string_view result;
    std::optional<std::uint32_t> pre_roll;
    EffectInfo info;

    std::string_view keep(std::string_view text) { return strings.emplace_back(text); }
    /// Null: no image of the file has this name.
    [[nodiscard]] FileImage* find_image(std::string_view name);
    [[nodiscard]] FileBuffer* find_buffer(std::string_view name);
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
[[nodiscard]] Result<> declare_value(Description& out, std::string_view text);
[[nodiscard]] Result<> declare_buffer(Description& out, std::string_view text);
[[nodiscard]] Result<> read_result(Description& out, std::string_view text);
[[nodiscard]] Result<> read_pre_roll(Description& out, std::string_view text);
[[nodiscard]] Result<FileFunction> read_pass(Description& out, std::string_view text);
[[nodiscard]] Result<FileFunction> read_compute(Description& out, std::string_view text);
[[nodiscard]] Result<FileFunction> read_end(Description& out, std::string_view text);
/// A name that neither an image nor a buffer has, nor the kernel.
[[nodiscard]] Result<> check_own_name(Description& out, std::string_view name);
/// "HEAD: IMAGE ... -> IMAGE ...": a pass with what it reads, and with outputs that are still to be checked.
[[nodiscard]] Result<FileFunction> read_arrow(Description& out, FileFunction pass, std::string_view text,
                                              std::string_view usage);
/// The image that the pass will write.
[[nodiscard]] Result<FileImage*> take_output(Description& out, std::string_view pass, std::string_view name);
/// What holds of the whole once every line was read.
[[nodiscard]] Result<> check_passes(Description& out);

/// The code asks for nothing that GLSL has in the other stage alone. `line` is where an error is.
[[nodiscard]] Result<> check_stage(std::string_view code, bool is_compute, std::size_t& line);
/// Adds the images of the frame that `code`, the function's own, names, and says which images are loaded alone.
[[nodiscard]] Result<> read_uses(const Description& from, FileFunction& function, std::string_view code);
/// The function takes the effect's parameters by their struct. `form` is how it is declared; `line` is where an error
/// is.
[[nodiscard]] Result<> check_struct(std::string_view code, std::string_view function, std::string_view struct_name,
                                    std::string_view form, std::size_t& line);
/// Takes note of the `shared` variables of a compute pass; others have none. `line` is where an error is.
[[nodiscard]] Result<> read_shared(FileFunction& function, std::string_view code, std::size_t& line);
/// Files define functions, structs and constants; the kernels around them declare what they read and write. Returns the
/// text with the values of its `#define`s in place, line by line: a macro would reach the effects of the same kernel.
[[nodiscard]] Result<std::string> expand_code(std::string_view text, std::size_t& line);

/// The code with the effect's name before the names of its functions, structs and constants, but for those that begin
/// with it: an effect beside it in a kernel may have a helper of the same name.
[[nodiscard]] std::string with_own_names(std::string_view code, std::string_view effect);

/// The whole file; errors read "shown_name:line: ...".
[[nodiscard]] Result<> read_description(Description& out, std::string_view text, std::string_view shown_name);

void build(PassBuilder& builder, const Description& description);

}  // namespace darkroom::custom
