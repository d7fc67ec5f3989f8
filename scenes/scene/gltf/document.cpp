// SPDX-License-Identifier: MIT
#include "scene/gltf/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <tuple>

#include "core/files.hpp"
#include "image/codec/decoder.hpp"
#include "scene/gltf/container.hpp"

namespace darkroom::scene::gltf {
namespace {

using nlohmann::json;

// The format of .glb counts in 32 bits; nothing larger is a model.
constexpr std::size_t max_missing_bytes = std::size_t{1} << 20;
constexpr std::size_t max_file_bytes = std::size_t{1} << 32;

// EXT_texture_webp: a texture may have another image for those who cannot read it.
void choose_webp(json& textures) {
    const auto source = json::json_pointer("/extensions/EXT_texture_webp/source");
    for (json& texture : textures)
        if (texture.contains(source)) texture["source"] = texture.at(source);
}

// EXT_meshopt_compression: what has no bytes, since all of them are unpacked from others.
bool is_fallback(const json& buffer) {
    const auto extension = json::json_pointer("/extensions/EXT_meshopt_compression/fallback");
    return buffer.contains(extension) && buffer.at(extension).get<bool>();
}

}  // namespace

Result<Document> Document::open(const std::filesystem::path& path, Budget budget, NamedFiles named_files) {
    Document document;
    document.named_files_ = named_files;
    document.budget_ = std::move(budget);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return user_error("not found");
    DARKROOM_TRY_VALUE(document.file_, read_bounded(path, max_file_bytes, true));
    document.budget_.add_file(document.file_.size());
    try {
        DARKROOM_TRY_VALUE(auto container, split_container(document.file_, document.budget_));
        for (std::string& warning : container.warnings) document.faults_.warn(std::move(warning));
        json& root = container.json;
        DARKROOM_TRY(check_structure(root, document.faults_, document.budget_));
        const std::filesystem::path folder = path.parent_path();
        DARKROOM_TRY(document.load_buffers(root, container.binary, container.has_binary, folder));
        const json images = root.contains("images") ? std::move(root["images"]) : json::array();
        root.erase("images");
        if (root.contains("textures")) choose_webp(root["textures"]);
        if (root.contains("bufferViews")) document.unpack_views(root["bufferViews"]);
        DARKROOM_TRY(document.parse(root));
        document.unpack_meshes();
        document.load_images(images, folder);
    } catch (const std::exception& exception) {
        return user_error(fmt::format("cannot be read: {}", exception.what()));
    }
    DARKROOM_TRY(document.budget_.check());
    return document;
}

Result<std::span<const std::byte>> Document::file_of_buffer(const std::filesystem::path& path, std::size_t most) {
    const auto [found, is_new] = buffer_files_.try_emplace(path);
    if (!is_new) return std::span<const std::byte>(found->second);
    DARKROOM_TRY_VALUE(found->second, read_bounded(path, most, false));
    budget_.add_file(found->second.size());
    return std::span<const std::byte>(found->second);
}

Result<> Document::load_buffer(const json& buffer, std::size_t index, std::size_t largest,
                               const std::filesystem::path& folder) {
    const std::string pointer = fmt::format("/buffers/{}", index);
    const auto size = buffer["byteLength"].get<std::size_t>();
    const auto uri = buffer["uri"].get<std::string>();
    const auto wrong = [&](std::string_view what) { return user_error(fmt::format("{}: {}", pointer, what)); };
    std::span<const std::byte> bytes;
    if (is_data_uri(uri)) {
        auto decoded = decode_data_uri(uri);
        if (!decoded) return wrong(decoded.error().text);
        bytes = data_uris_.emplace_back(std::move(*decoded));
        if (bytes.size() > size)
            faults_.warn(fmt::format("{}: has {} bytes, byteLength is {}", pointer, bytes.size(), size));
    } else {
        const auto path = resolve_uri(folder, uri, named_files_);
        if (!path) return wrong(path.error().text);
        const auto file = file_of_buffer(*path, largest);
        if (!file) return wrong(fmt::format("{}: {}", uri, file.error().text));
        bytes = *file;
    }
    if (bytes.size() < size) return wrong(fmt::format("has {} bytes, byteLength is {}", bytes.size(), size));
    buffers_[index] = bytes.first(size);
    return {};
}

Result<> Document::load_buffers(json& root, std::span<const std::byte> binary, bool has_binary,
                                const std::filesystem::path& folder) {
    const json buffers = root.contains("buffers") ? std::move(root["buffers"]) : json::array();
    root.erase("buffers");
    std::size_t largest = 0;
    for (const json& buffer : buffers) largest = std::max(largest, buffer["byteLength"].get<std::size_t>());
    largest = std::min(largest, max_file_bytes);
    zeros_.resize(std::min(largest, max_missing_bytes));
    buffers_.resize(buffers.size());
    bool is_binary_used = false;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string pointer = fmt::format("/buffers/{}", i);
        if (!faults_.check(pointer)) continue;
        if (buffers[i].contains("uri")) {
            if (auto loaded = load_buffer(buffers[i], i, largest, folder); !loaded)
                faults_.add(pointer, loaded.error().text);
            if (budget_.file_bytes() > max_file_bytes)
                return user_error(fmt::format("{}: the buffers have more than {} bytes", pointer, max_file_bytes));
            continue;
        }
        const auto size = buffers[i]["byteLength"].get<std::size_t>();
        if (is_fallback(buffers[i]) && (i != 0 || !has_binary)) continue;
        is_binary_used = is_binary_used || i == 0;
        if (i != 0 || !has_binary) {
            // Its data were to come from elsewhere, which is allowed; without them they are zeros.
            if (size > max_missing_bytes)
                faults_.add(pointer, fmt::format("{}: has neither a URI nor a BIN chunk", pointer));
            else
                faults_.warn(fmt::format("{}: has neither a URI nor a BIN chunk; it is all zeros", pointer));
            buffers_[i] = std::span(zeros_).first(std::min(size, zeros_.size()));
        } else if (size > binary.size()) {
            faults_.add(pointer,
                        fmt::format("{}/byteLength: {}, the BIN chunk has {} bytes", pointer, size, binary.size()));
        } else {
            if (binary.size() - size > 3)
                faults_.warn(
                    fmt::format("{}/byteLength: {}, the BIN chunk has {} bytes", pointer, size, binary.size()));
            buffers_[i] = binary.first(size);
        }
    }
    if (has_binary && !is_binary_used) faults_.warn("the BIN chunk is not used");
    return {};
}

Result<> Document::parse(json& root) {
    // The library refuses files with indices that have no bufferView (all of them are 0); it is given one until it is
    // done.
    std::vector<std::size_t> without_view;
    if (root.contains("accessors"))
        for (std::size_t i = 0; i < root["accessors"].size(); ++i) {
            if (root["accessors"][i].contains("bufferView")) continue;
            if (root["accessors"][i].contains("byteOffset"))
                faults_.warn(fmt::format("/accessors/{}/byteOffset: without a bufferView", i));
            without_view.push_back(i);
            root["accessors"][i]["bufferView"] = 0;
        }
    if (!without_view.empty() && !root.contains("bufferViews"))
        root["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", 1}}});

    const std::string text = root.dump();
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks({});
    loader.RemoveImageLoader();
    std::string error;
    std::string warning;
    if (!loader.LoadASCIIFromString(&model_, &error, &warning, text.data(), static_cast<unsigned>(text.size()), ""))
        return user_error(error.empty() ? "is refused by the glTF reader" : one_printable_line(error));
    for (const std::size_t i : without_view) model_.accessors[i].bufferView = -1;

    for (std::size_t i = 0; i < model_.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = model_.bufferViews[i];
        const std::string pointer = fmt::format("/bufferViews/{}", i);
        if (static_cast<std::size_t>(view.buffer) >= buffers_.size() || !faults_.check(pointer)) continue;
        if (unpacked_views_.contains(i)) continue;
        if (const auto checked = faults_.check(fmt::format("/buffers/{}", view.buffer)); !checked) {
            faults_.add(pointer, checked.error().text);
            continue;
        }
        if (view.byteStride != 0 && view.target == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER)
            faults_.warn(fmt::format("{}/byteStride: only vertices have one", pointer));
        const std::size_t size = buffers_[static_cast<std::size_t>(view.buffer)].size();
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
            faults_.add(pointer, fmt::format("{}: bytes {} to {}, buffer {} has {}", pointer, view.byteOffset,
                                             view.byteOffset + view.byteLength, view.buffer, size));
    }
    for (std::size_t i = 0; i < model_.accessors.size(); ++i) {
        layouts_.emplace_back();
        const std::string pointer = fmt::format("/accessors/{}", i);
        if (!faults_.check(pointer)) continue;
        auto made = make_layout(static_cast<int>(i));
        if (made)
            layouts_.back() = *made;
        else
            faults_.add(pointer, made.error().text);
        if (made) check_extent(static_cast<int>(i));
    }
    return {};
}

void Document::load_images(const json& images, const std::filesystem::path& folder) {
    std::map<std::tuple<const std::byte*, std::size_t, std::filesystem::path>, std::size_t> known;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const json& image = images[i];
        const std::string pointer = fmt::format("/images/{}", i);
        ImageSource source;
        source.shown = pointer;
        if (image.contains("name")) source.name = image["name"].get<std::string>();
        if (const auto checked = faults_.check(pointer); !checked) {
            source.fault = checked.error().text;
        } else if (image.contains("uri") == image.contains("bufferView")) {
            source.fault = fmt::format("{}: needs either a uri or a bufferView", pointer);
        } else if (image.contains("bufferView")) {
            const auto bytes = view(image["bufferView"].get<int>());
            if (bytes)
                source.bytes = *bytes;
            else
                source.fault = fmt::format("{}: {}", pointer, bytes.error().text);
            if (!image.contains("mimeType")) faults_.warn(fmt::format("{}/mimeType: is missing", pointer));
        } else if (const auto uri = image["uri"].get<std::string>(); is_data_uri(uri)) {
            const bool is_webp = uri.starts_with("data:image/webp;") && uses_extension("EXT_texture_webp");
            if (!uri.starts_with("data:image/png;") && !uri.starts_with("data:image/jpeg;") && !is_webp)
                faults_.warn(fmt::format("{}/uri: image/png and image/jpeg are allowed", pointer));
            auto bytes = decode_data_uri(uri);
            if (bytes)
                source.own_bytes = std::move(*bytes);
            else
                source.fault = fmt::format("{}: {}", pointer, bytes.error().text);
        } else {
            auto path = resolve_uri(folder, uri, named_files_);
            if (path)
                source.file = std::move(*path);
            else
                source.fault = fmt::format("{}: {}", pointer, path.error().text);
            source.shown = fmt::format("{}: {}", pointer, uri);
            if (source.name.empty()) source.name = uri;
        }
        const std::span<const std::byte> bytes = source.own_bytes.empty() ? source.bytes : std::span(source.own_bytes);
        const auto [found, is_new] = known.try_emplace({bytes.data(), bytes.size(), source.file}, images_.size());
        const bool is_same = !is_new && source.fault.empty();
        image_of_.push_back(is_same ? found->second : images_.size());
        if (!is_same) images_.push_back(std::move(source));
    }
    for (ImageSource& source : images_)
        if (!source.own_bytes.empty()) source.bytes = source.own_bytes;
}

bool Document::uses_extension(std::string_view name) const {
    return std::find(model_.extensionsUsed.begin(), model_.extensionsUsed.end(), name) != model_.extensionsUsed.end();
}

Result<std::span<const std::byte>> Document::view(int index) {
    DARKROOM_TRY(faults_.check(fmt::format("/bufferViews/{}", index)));
    if (const auto found = unpacked_views_.find(static_cast<std::size_t>(index)); found != unpacked_views_.end())
        return found->second;
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
    return buffers_[static_cast<std::size_t>(view.buffer)].subspan(view.byteOffset, view.byteLength);
}

}  // namespace darkroom::scene::gltf
