// SPDX-License-Identifier: MIT
#pragma once
// A glTF file whose structure has been checked: the parsing library's tables, the bytes of the buffers, and accessors
// that are safe to read. It makes nothing of them; the conversions (gltf_convert.hpp) do. This and the files that
// include it are the only ones that know the library.

#include <tiny_gltf.h>

#include <cstddef>
#include <darkroom/result.hpp>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/budget.hpp"
#include "scene/named_files.hpp"

namespace darkroom::scene::gltf {

// The shape that the JSON of a glTF file must have: which properties, of which types, which indices into which arrays.
// What passes here is safe to hand to the parsing library. It does not look at the data that accessors describe.

/// What is wrong with the elements of a file, by JSON pointer of the element ("/meshes/3"). A faulty element is an
/// error only for what needs it; the others become warnings in the end. Texts begin with the pointer of the fault.
class Faults {
  public:
    void warn(std::string text);
    void add(const std::string& element, std::string text);
    /// An error if the element is faulty.
    [[nodiscard]] Result<> check(const std::string& element);
    /// All warnings, those of faults that nothing needed last.
    [[nodiscard]] std::vector<std::string> take_warnings();

  private:
    [[nodiscard]] bool contains(std::string_view text) const;

    std::map<std::string, std::string> faults_;
    std::vector<std::string> order_;
    std::vector<std::string> warnings_;
};

/// Removes what is not known here and replaces faulty elements of the arrays by harmless ones of the same index.
/// Errors: faults of the file as a whole, such as a required extension that is not read here, or more elements than the
/// budget has room for.
[[nodiscard]] Result<> check_structure(nlohmann::json& root, Faults& faults, Budget& budget);

/// Elements of an accessor as numbers: normalised integers as -1..1 or 0..1, others as they are.
struct Numbers {
    std::vector<float> values;
    std::uint32_t components = 1;
    std::size_t count = 0;
};

/// Where the elements of an accessor are. Everything lies inside the buffers.
struct Layout {
    std::size_t count = 0;
    std::uint32_t components = 1;
    int component_type = 0;
    bool is_normalized = false;
    std::span<const std::byte> data;  ///< from the first element; empty: all elements are 0
    std::size_t stride = 0;
    std::size_t sparse_count = 0;
    int sparse_type = 0;
    std::span<const std::byte> sparse_indices, sparse_values;
};

/// The encoded bytes of an image, or the file they are in, or what is wrong with it.
struct ImageSource {
    std::string name;
    std::span<const std::byte> bytes;
    std::vector<std::byte> own_bytes;  ///< of a data URI; `bytes` views them
    std::filesystem::path file;
    std::string shown;  ///< what a message calls the file
    std::string fault;
};

class Document {
  public:
    /// Errors are without the path.
    [[nodiscard]] static Result<Document> open(const std::filesystem::path& path, Budget budget,
                                               NamedFiles named_files);

    [[nodiscard]] const tinygltf::Model& model() const { return model_; }
    [[nodiscard]] Faults& faults() { return faults_; }
    /// Each once, however many images of the file have the same bytes.
    [[nodiscard]] std::vector<ImageSource>& images() { return images_; }
    /// Which of them is an image of the file.
    [[nodiscard]] std::size_t image_of(int index) const { return image_of_[static_cast<std::size_t>(index)]; }

    /// The error names the accessor and what is wrong with it.
    [[nodiscard]] Result<const Layout*> layout(int accessor);
    [[nodiscard]] Result<Numbers> numbers(int accessor);
    /// Unsigned integers as they are; refuses other types.
    [[nodiscard]] Result<std::vector<std::uint32_t>> integers(int accessor);
    /// Accessors are charged to it as they are read: many of them may name the same bytes, or none.
    [[nodiscard]] Budget& budget() { return budget_; }
    [[nodiscard]] bool uses_extension(std::string_view name) const;

  private:
    [[nodiscard]] Result<> load_buffers(nlohmann::json& root, std::span<const std::byte> binary, bool has_binary,
                                        const std::filesystem::path& folder);
    [[nodiscard]] Result<> load_buffer(const nlohmann::json& buffer, std::size_t index, std::size_t largest,
                                       const std::filesystem::path& folder);
    [[nodiscard]] Result<std::span<const std::byte>> file_of_buffer(const std::filesystem::path& path,
                                                                    std::size_t most);
    [[nodiscard]] Result<> parse(nlohmann::json& root);
    void unpack_views(nlohmann::json& views);
    [[nodiscard]] Result<> unpack_view(const nlohmann::json& view, std::size_t index);
    void unpack_meshes();
    [[nodiscard]] Result<> unpack_primitive(const tinygltf::Primitive& primitive, const std::string& pointer);
    [[nodiscard]] Result<std::span<const std::byte>> view(int index);
    [[nodiscard]] Result<Layout> make_layout(int accessor);
    void check_extent(int accessor);
    [[nodiscard]] Result<> add_sparse(const tinygltf::Accessor& accessor, const std::string& pointer, Layout& layout);
    void load_images(const nlohmann::json& images, const std::filesystem::path& folder);

    tinygltf::Model model_;
    Faults faults_;
    std::vector<std::byte> file_;
    std::map<std::filesystem::path, std::vector<std::byte>> buffer_files_;  ///< each once, however many name it
    std::deque<std::vector<std::byte>> data_uris_;
    std::vector<std::byte> zeros_;  ///< what buffers that are nowhere share
    std::vector<std::span<const std::byte>> buffers_;
    std::deque<std::vector<std::byte>> unpacked_;
    std::map<std::size_t, std::span<const std::byte>> unpacked_views_;
    std::vector<std::optional<Layout>> layouts_;
    std::map<int, int> packed_in_;  ///< accessors that have been unpacked, and the bufferView they were in
    std::vector<ImageSource> images_;
    std::vector<std::size_t> image_of_;
    Budget budget_;
    NamedFiles named_files_ = NamedFiles::Own;
};

}  // namespace darkroom::scene::gltf
