// SPDX-License-Identifier: MIT
#pragma once
// What a scene names, loaded: models, textures of materials, sprites and particles, and the skybox. A file that is
// missing or broken is reported by name and the rest goes on; each file is loaded once, however many name it.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/picture/picture.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {

struct EntityAssets {
    std::uint32_t model = no_index;             ///< in Assets::models
    std::uint32_t material_texture = no_index;  ///< in Assets::images
    std::uint32_t sprite_texture = no_index;
    std::uint32_t particle_texture = no_index;
};

struct Assets {
    std::vector<Model> models;
    std::vector<Image> images;
    std::vector<EntityAssets> entities;        ///< one for each of the scene's
    std::optional<Picture> skybox;             ///< linear Rec. 709, as the file has it
    std::vector<std::filesystem::path> files;  ///< that were found, models and pictures
    std::vector<std::string> warnings;         ///< one line each, naming the file and who asked for it
    std::vector<Error> model_errors;           ///< of the models that could not be had, which are in `warnings`, too
    /// The first failure of this machine (no memory, no file handle): what is here is not what the scene asks for, and
    /// check_snapshot refuses it.
    std::optional<Error> machine_error;
};

/// Never fails: what cannot be had is in `warnings`. Files are decoded on several threads.
[[nodiscard]] Assets load_assets(const Scene& scene);

/// Decodes an image file (or the bytes of one) to four bytes a pixel; 16-bit and float ones are reduced.
[[nodiscard]] Result<Image> read_image(const std::filesystem::path& path);
[[nodiscard]] Result<Image> decode_image(std::span<const std::byte> bytes, std::string name);

}  // namespace darkroom::scene
