// SPDX-License-Identifier: MIT
#pragma once
// A glTF file whose structure has been checked: the parsing library's tables, the bytes of the buffers, and accessors
// that are safe to read. It makes nothing of them; the conversions (gltf_convert.hpp) do. This and the files that
// include it are the only ones that know the library.

#include <tiny_gltf.h>

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_schema.hpp"

namespace darkroom::scene::gltf {

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
    [[nodiscard]] static Result<Document> open(const std::filesystem::path& path);

    [[nodiscard]] const tinygltf::Model& model() const { return model_; }
    [[nodiscard]] Faults& faults() { return faults_; }
    [[nodiscard]] std::vector<ImageSource>& images() { return images_; }

    /// The error names the accessor and what is wrong with it.
    [[nodiscard]] Result<const Layout*> layout(int accessor);
    [[nodiscard]] Result<Numbers> numbers(int accessor);
    /// Unsigned integers as they are; refuses other types.
    [[nodiscard]] Result<std::vector<std::uint32_t>> integers(int accessor);
    /// What accessors become must stay in proportion to the file: many of them may name the same bytes, or none.
    [[nodiscard]] Result<> charge(const std::string& pointer, std::size_t bytes);
    /// For giving back what a conversion took for a time.
    [[nodiscard]] std::size_t budget() const { return budget_; }
    void set_budget(std::size_t budget) { budget_ = budget; }
    [[nodiscard]] bool uses_extension(std::string_view name) const;

  private:
    [[nodiscard]] Result<> load_buffers(nlohmann::json& root, std::span<const std::byte> binary, bool has_binary,
                                        const std::filesystem::path& folder);
    [[nodiscard]] Result<std::vector<std::byte>> load_buffer(const nlohmann::json& buffer, std::size_t index,
                                                             const std::filesystem::path& folder);
    [[nodiscard]] Result<> parse(nlohmann::json& root);
    [[nodiscard]] Result<std::span<const std::byte>> view(int index);
    [[nodiscard]] Result<Layout> make_layout(int accessor);
    void check_extent(int accessor);
    [[nodiscard]] Result<> add_sparse(const tinygltf::Accessor& accessor, const std::string& pointer, Layout& layout);
    void load_images(const nlohmann::json& images, const std::filesystem::path& folder);

    tinygltf::Model model_;
    Faults faults_;
    std::vector<std::byte> file_;
    std::vector<std::vector<std::byte>> owned_buffers_;
    std::vector<std::span<const std::byte>> buffers_;
    std::vector<std::optional<Layout>> layouts_;
    std::vector<ImageSource> images_;
    std::size_t budget_ = 0;  ///< bytes that may still be taken
    std::size_t work_ = 0;    ///< bytes that may still be converted; never given back
};

}  // namespace darkroom::scene::gltf
