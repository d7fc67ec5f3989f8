// SPDX-License-Identifier: MIT
#include "scene/assets.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/lies_in.hpp"
#include "core/thread/parallel.hpp"
#include "image/codec/decoder.hpp"
#include "image/frame/frame_file.hpp"
#include "scene/image_batch.hpp"
#include "scene/pose/snapshot_parts.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {

namespace {

// What a scene's choice of Skins does to its figures, in words. It draws nothing.

// Of the pose of the file. A mesh that many nodes draw counts once: nodes may be many more than vertices.
Box figure_bounds(const Model& model, const mat4& world, Skins skins) {
    const Pose at_rest = pose(model, no_index, 0, skins);
    std::vector<bool> is_done(model.meshes.size());
    Box out;
    for (const Node& node : model.nodes) {
        if (node.mesh >= model.meshes.size() || node.skin >= model.skins.size() || is_done[node.mesh]) continue;
        is_done[node.mesh] = true;
        std::vector<mat4> joints;
        for (const mat4& joint : at_rest.joints[node.skin]) joints.push_back(world * joint);
        for (const Primitive& primitive : model.meshes[node.mesh].primitives) {
            if (primitive.skin.empty()) continue;
            for (const vec3& point : deform(primitive, world, joints, {})) out.add(point);
        }
    }
    return out;
}

bool differ(const Box& a, const Box& b) {
    constexpr float least_change = 0.01F;  // of the larger: what would be seen
    for (int axis = 0; axis < 3; ++axis) {
        const float first = a.size()[axis], second = b.size()[axis];
        if (std::abs(first - second) > least_change * std::max(first, second)) return true;
    }
    return false;
}

/// One line for each model whose figures are not as high, or not as wide, as all nodes of the model would make them,
/// where the scene does not say its Skins.
std::vector<std::string> figure_notices(const Scene& scene, const Assets& assets) {
    std::vector<std::string> notices;
    if (!scene.has_assumed_skins) return notices;
    std::vector<bool> is_done(assets.models.size());
    for (std::uint32_t i = 0; i < scene.entities.size(); ++i) {
        const std::uint32_t number = assets_of(assets, i).model;
        if (number == no_index || is_done[number]) continue;
        is_done[number] = true;
        const Model& model = assets.models[number];
        const mat4 world = entity_world(scene, i, 0);
        const Box by_joints = figure_bounds(model, world, Skins::JointsOnly);
        const Box by_all = figure_bounds(model, world, Skins::AllNodes);
        if (by_joints.is_empty() || by_all.is_empty() || !differ(by_joints, by_all)) continue;
        notices.push_back(
            fmt::format("{}: entities.{}.model: the figure is {:.3g} m high by its joints alone, for which scenes of "
                        "this style are placed; skins = \"all_nodes\" in [scene] makes it {:.3g} m",
                        place_of(scene, scene.entities[i]), one_printable_line(scene.entities[i].name),
                        by_joints.size().y, by_all.size().y));
    }
    return notices;
}

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

/// A folder that files are looked for in, and a name there.
struct FilePlace {
    fs::path folder, name;
    [[nodiscard]] fs::path path() const { return folder / name; }
};

/// If nothing better is found, a name that exists but is not a file stands for the scene's: opening it gives the error.
fs::path first_file(std::span<const FilePlace> places, NamedFiles named_files) {
    const auto may_be = [&](const FilePlace& place) {
        return named_files == NamedFiles::Any || lies_in(place.folder, place.path());
    };
    for (const FilePlace& place : places)
        if (is_file(place.path()) && may_be(place)) return place.path();
    for (const FilePlace& place : places)
        if (std::error_code error; fs::exists(place.path(), error) && !fs::is_directory(place.path(), error))
            if (may_be(place)) return place.path();
    return {};
}

std::vector<FilePlace> model_places(const fs::path& folder, const std::string& asset) {
    const fs::path name(asset);
    const bool is_model_file = is_model_path(name);
    std::vector<FilePlace> places;
    if (is_model_file) places.push_back({folder, name});
    for (const char* models : {"models", "../models"}) {
        if (is_model_file) places.push_back({folder / models, name});
        places.push_back({folder / models, asset + ".glb"});
        places.push_back({folder / models, asset + ".gltf"});
    }
    return places;
}

std::vector<FilePlace> texture_places(const fs::path& folder, const fs::path& name) {
    return {{folder, name}, {folder / "textures", name}, {folder / "../textures", name}};
}

/// Which files are wanted, each once, in the order in which they are first asked for.
class FileList {
  public:
    std::uint32_t add(const fs::path& file, const std::string& asked_for_by) {
        std::error_code error;
        const fs::path canonical = fs::weakly_canonical(file, error);
        const auto [found, is_new] =
            index_.emplace(error ? file : canonical, static_cast<std::uint32_t>(files_.size()));
        if (is_new) {
            files_.push_back(file);
            asked_for_by_.push_back(asked_for_by);
        }
        return found->second;
    }
    [[nodiscard]] const std::vector<fs::path>& files() const { return files_; }
    [[nodiscard]] const std::string& asked_for_by(std::size_t i) const { return asked_for_by_[i]; }

  private:
    std::map<fs::path, std::uint32_t> index_;
    std::vector<fs::path> files_;
    std::vector<std::string> asked_for_by_;
};

std::string entity_name(const Entity& entity) { return fmt::format("entity '{}'", one_printable_line(entity.name)); }

struct Wanted {
    FileList models, images;
    fs::path skybox;
};

Wanted find_files(const Scene& scene, Assets& assets) {
    Wanted wanted;
    /// Empty, with a warning, where there is none.
    const auto find = [&](std::span<const FilePlace> places, const std::string& asked_for, const std::string& by) {
        fs::path file = first_file(places, scene.named_files);
        if (!file.empty()) return file;
        const bool is_there = !first_file(places, NamedFiles::Any).empty();
        assets.warnings.push_back(fmt::format("{}: {} asks for '{}': {}", one_printable_line(scene.file.string()), by,
                                              one_printable_line(asked_for),
                                              is_there ? "leaves the folder of the scene" : "there is no such file"));
        return file;
    };
    const auto texture = [&](const fs::path& name, const std::string& by) {
        if (name.empty()) return no_index;
        const fs::path file = find(texture_places(scene.folder, name), name.string(), by);
        return file.empty() ? no_index : wanted.images.add(file, by);
    };
    if (!scene.environment.skybox.empty()) {
        const fs::path& name = scene.environment.skybox;
        wanted.skybox = find(texture_places(scene.folder, name), name.string(), "the environment");
    }
    for (const Entity& entity : scene.entities) {
        const std::string by = entity_name(entity);
        EntityAssets& found = assets.entities.emplace_back();
        if (entity.model && !entity.model->asset.empty()) {
            const std::string& asset = entity.model->asset;
            const fs::path file = find(model_places(scene.folder, asset), asset, by);
            if (!file.empty()) found.model = wanted.models.add(file, by);
        }
        if (entity.material) found.material_texture = texture(entity.material->texture, by);
        if (entity.sprite) found.sprite_texture = texture(entity.sprite->texture, by);
        if (entity.emitter) found.particle_texture = texture(entity.emitter->texture, by);
    }
    return wanted;
}

// What could not be loaded leaves an empty place behind, which nobody names any more.
void forget(std::vector<EntityAssets>& entities, std::uint32_t EntityAssets::*member, std::size_t index) {
    for (EntityAssets& entity : entities)
        if (entity.*member == index) entity.*member = no_index;
}

}  // namespace

Assets load_assets(const Scene& scene) {
    Assets assets;
    const Wanted wanted = find_files(scene, assets);
    if (!wanted.skybox.empty()) assets.files.push_back(wanted.skybox);
    for (const FileList* const list : {&wanted.models, &wanted.images})
        assets.files.insert(assets.files.end(), list->files().begin(), list->files().end());

    // The skybox and the models are loaded side by side, the skybox first, since it is often the largest.
    const std::vector<fs::path>& model_files = wanted.models.files();
    std::vector<Result<Model>> models(model_files.size());
    std::optional<Result<FrameFile>> sky;
    parallel_for(model_files.size() + 1, 0, [&](std::size_t i) {
        if (i > 0)
            models[i - 1] = read_model(model_files[i - 1], Budget(0, model_files.size()), scene.named_files);
        else if (!wanted.skybox.empty())
            sky = read_frame(wanted.skybox, {.has_shadow_depths = false});
    });
    std::vector<EncodedImage> sources;
    for (const fs::path& file : wanted.images.files())
        sources.push_back({.name = file.filename().string(), .file = file});
    std::vector<Result<Image>> images = decode_images(sources);

    const auto note = [&](const Error& error, const std::string& text) {
        if (error.fault == Fault::Machine && !assets.machine_error) assets.machine_error = Error{error.fault, text};
        assets.warnings.push_back(text);
    };
    if (sky && *sky) {
        assets.skybox = std::move((*sky)->color);
        for (const std::string& warning : (*sky)->warnings)
            assets.warnings.push_back(fmt::format("{}: {}", wanted.skybox.string(), warning));
    } else if (sky) {
        note(sky->error(), fmt::format("{} (asked for by the environment)", sky->error().text));
    }
    for (std::size_t i = 0; i < models.size(); ++i) {
        if (models[i]) {
            assets.models.push_back(std::move(*models[i]));
            for (const std::string& warning : assets.models.back().warnings)
                assets.warnings.push_back(fmt::format("{}: {}", model_files[i].string(), warning));
            continue;
        }
        note(models[i].error(),
             fmt::format("{} (asked for by {})", models[i].error().text, wanted.models.asked_for_by(i)));
        assets.model_errors.push_back(models[i].error());
        assets.models.emplace_back();
        forget(assets.entities, &EntityAssets::model, i);
    }
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (images[i]) {
            assets.images.push_back(std::move(*images[i]));
            continue;
        }
        note(images[i].error(), fmt::format("{}: {} (asked for by {})", wanted.images.files()[i].string(),
                                            images[i].error().text, wanted.images.asked_for_by(i)));
        assets.images.push_back({.name = sources[i].name});
        for (const auto member :
             {&EntityAssets::material_texture, &EntityAssets::sprite_texture, &EntityAssets::particle_texture})
            forget(assets.entities, member, i);
    }
    for (std::string& notice : figure_notices(scene, assets)) assets.warnings.push_back(std::move(notice));
    return assets;
}

}  // namespace darkroom::scene
