// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <unordered_map>

#include "core/files.hpp"
#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "scene/read/scene_file.hpp"
#include "scene/read/scene_reader.hpp"

namespace darkroom::scene {

namespace reading {

SceneReader::SceneReader(const toml::table& file, const std::filesystem::path& path, const SceneOptions& options)
    : file_(file), options_(options), report_(options.is_strict) {
    report_.add_file(printable(path.string()));
    scene_.file = path;
    scene_.folder = path.parent_path();
    scene_.name = path.stem().string();
    if (constexpr std::string_view kind = ".scene"; scene_.name.ends_with(kind))
        scene_.name.resize(scene_.name.size() - kind.size());
}

Result<Scene> SceneReader::read() {
    read_top();
    PrefabExpander prefabs(report_, trees_, scene_.folder, options_.named_files);
    const std::vector<RawEntity> entities = prefabs.expand(level_of(file_, 0, scene_.folder));
    scene_.file_bytes = prefabs.file_bytes();
    if (prefabs.is_full()) return failure(report_.finish(options_.warnings).error());
    scene_.entities.reserve(entities.size());
    for (const RawEntity& raw : entities) read_entity(raw);
    report_unknown_components();
    link_parents();
    inherit_base_colors();
    DARKROOM_TRY(report_.finish(options_.warnings));
    return std::move(scene_);
}

// Of the same file, [post_process], [[stack]], [[pulse]], [[layer]] and format are the look's, [ui] is the interface
// layer's, and [prefab] is the heading of files that are templates.
void SceneReader::read_top() {
    const std::vector<std::string> names{"scene",      "camera",   "environment",  "prefabs", "templates",
                                         "archetypes", "entities", "post_process", "stack",   "pulse",
                                         "layer",      "format",   "ui",           "prefab"};
    for (const auto& [key, node] : file_) {
        if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
        report_.slip(place_of(key.source(), 0), [&, &name = key] {
            return fmt::format("unknown key '{}'{}", printable(name.str()), report_.suggestion(name.str(), names));
        });
    }
    if (const Value value = table_at("scene"); value.is_table()) read_scene_table(value);
    const auto read_table = [&](std::string_view key, auto read_values, auto& out) {
        const Value value = table_at(key);
        if (!value.is_table()) return;
        const Where where{.name = key};
        TableReader table(reader_, value, where);
        read_values(table, out);
        table.finish();
    };
    read_table("camera", read_camera, scene_.camera);
    read_table("environment", read_environment, scene_.environment);
}

Value SceneReader::table_at(std::string_view key) {
    const toml::node* const node = file_.get(key);
    if (node == nullptr) return {};
    if (node->is_table()) return trees_.build(*node, 0);
    expect_table(key, *node);
    return {};
}

void SceneReader::expect_table(std::string_view key, const toml::node& node) {
    report_.error(place_of(node.source(), 0),
                  [&] { return fmt::format("{} = {}: expected a table", key, darkroom::show(node)); });
}

void SceneReader::read_scene_table(const Value& value) {
    const Where where{.name = "scene"};
    TableReader table(reader_, value, where);
    table.text("name", scene_.name);
    table.text("description", scene_.description, max_toml_bytes);
    table.number("time", scene_.time, {.low = 0, .high = 1e9, .unit = "s"});
    table.count("samples", scene_.samples, 1, max_samples);
    table.flag("grid", scene_.has_grid);
    table.flag("alpha_layer", scene_.has_alpha_layer);
    constexpr std::array skins_names{std::pair{std::string_view("all_nodes"), Skins::AllNodes},
                                     std::pair{std::string_view("joints_only"), Skins::JointsOnly}};
    // Only the engine whose importer keeps joints alone as parents writes these two keys.
    scene_.has_assumed_skins = !table.has("skins") && (table.has("version") || table.has("input_config"));
    if (scene_.has_assumed_skins) scene_.skins = Skins::JointsOnly;
    table.choice("skins", scene_.skins, skins_names);
    table.pass_over("version");
    table.pass_over("input_config");
    table.finish();
}

Value SceneReader::with_archetype(const RawEntity& raw, const std::string& archetype) {
    const toml::table* const scene_wide = file_["archetypes"].as_table();
    for (const toml::table* const table : {raw.archetypes, scene_wide}) {
        const toml::node* const node = table == nullptr ? nullptr : table->get(archetype);
        if (node == nullptr || !node->is_table()) continue;
        const std::uint32_t file = table == scene_wide ? 0 : raw.place.file;
        const auto [found, is_new] = archetypes_.try_emplace(node);
        if (is_new) {
            found->second.tree = trees_.build(*node, file);
            found->second.size = member_count(found->second.tree);
        }
        if (!trees_.charge(found->second.size, raw.place)) break;
        Value merged = found->second.tree;
        merge(merged, raw.table);
        return merged;
    }
    return raw.table;
}

void SceneReader::read_entity(const RawEntity& raw) {
    const Where up{.name = "entities"}, where{.up = &up, .name = raw.name};
    EntityDraft draft{.entity = {.name = raw.name, .place = report_.show(raw.place)}};
    ParentName parent;
    if (!raw.table.is_table()) {
        report_.error(raw.place,
                      [&] { return fmt::format("{} = {}: expected a table", where.text(), show(raw.table)); });
    } else {
        TableReader own(reader_, raw.table, where);
        own.text("archetype", draft.entity.archetype);
        if (own.text("parent", parent.name)) parent.place = own.place_of_value("parent");
        const auto read_members = [&](const Value& table) {
            for (const Member& member : table.members) read_member(member, where, draft);
        };
        if (draft.entity.archetype.empty())
            read_members(raw.table);
        else
            read_members(with_archetype(raw, draft.entity.archetype));
    }
    scene_.entities.push_back(std::move(draft.entity));
    base_colors_.push_back(draft.base_color);
    parents_.push_back(std::move(parent));
}

void SceneReader::read_member(const Member& member, const Where& where, EntityDraft& draft) {
    if (member.key == "archetype" || member.key == "parent") return;
    const ComponentReader* const component = find_component(member.key);
    if (component != nullptr && member.value.is_table()) {
        const Where place{.up = &where, .name = member.key};
        TableReader table(reader_, member.value, place);
        component->read(table, draft);
        return table.finish();
    }
    const auto text = [&](std::string_view what) {
        return fmt::format("{}.{} = {}: {}", where.text(), printable(member.key), show(member.value), what);
    };
    if (component != nullptr) return report_.error(member.value.place, [&] { return text("expected a table"); });
    if (member.value.is_table() || member.value.node->is_array_of_tables()) {
        auto found = unknown_.find(member.key);
        if (found == unknown_.end()) found = unknown_.emplace(member.key, UnknownComponent{member.place}).first;
        ++found->second.count;
        return;
    }
    report_.slip(member.place, [&] {
        std::vector<std::string> names{"archetype", "parent"};
        for (const ComponentReader& known : all_components()) names.emplace_back(known.name);
        return text("unknown key" + report_.suggestion(member.key, names));
    });
}

// Scenes of engines have components for physics, sound and rules: one line for each kind, however many there are.
void SceneReader::report_unknown_components() {
    std::vector<std::string> names;
    for (const ComponentReader& known : all_components()) names.emplace_back(known.name);
    for (const auto& [name, unknown] : unknown_)
        report_.slip(unknown.place, [&, &shown = name, count = unknown.count] {
            return fmt::format("component '{}' means nothing here, {} {} passed over{}", printable(shown), count,
                               count == 1 ? "is" : "are", report_.suggestion(shown, names));
        });
}

void SceneReader::link_parents() {
    std::unordered_map<std::string_view, std::uint32_t> indices;
    for (std::uint32_t i = 0; i < scene_.entities.size(); ++i) indices.emplace(scene_.entities[i].name, i);
    std::vector<std::string> names;  // some: suggestions are made for the first errors of a file only
    for (const Entity& entity : scene_.entities)
        if (names.size() < 1000) names.push_back(entity.name);
    for (std::uint32_t i = 0; i < scene_.entities.size(); ++i) {
        const ParentName& parent = parents_[i];
        if (parent.name.empty()) continue;
        if (const auto found = indices.find(parent.name); found != indices.end()) {
            scene_.entities[i].parent = found->second;
            continue;
        }
        report_.error(parent.place, [&] {
            return fmt::format("entities.{}.parent = \"{}\": there is no such entity{}",
                               printable(scene_.entities[i].name), printable(parent.name),
                               report_.suggestion(parent.name, names));
        });
    }
    report_cycles();
}

// Walks up from each entity. A walk that meets itself has found a cycle; one that meets an earlier walk ends there.
void SceneReader::report_cycles() {
    std::vector<std::uint32_t> walk_of(scene_.entities.size(), Entity::none);
    for (std::uint32_t start = 0; start < scene_.entities.size(); ++start) {
        std::uint32_t at = start;
        while (at != Entity::none && walk_of[at] == Entity::none) {
            walk_of[at] = start;
            at = scene_.entities[at].parent;
        }
        if (at == Entity::none || walk_of[at] != start) continue;
        report_.error(parents_[at].place, [&] {
            constexpr std::size_t max_names = 20;
            std::vector<std::string> chain{printable(scene_.entities[at].name)};
            for (std::uint32_t up = scene_.entities[at].parent; up != at && chain.size() < max_names;
                 up = scene_.entities[up].parent)
                chain.push_back(printable(scene_.entities[up].name));
            if (chain.size() == max_names) chain.emplace_back("...");
            chain.push_back(chain.front());
            return fmt::format("entities.{}.parent: entities are parents of themselves: {}",
                               printable(scene_.entities[at].name), fmt::join(chain, " -> "));
        });
        scene_.entities[at].parent = Entity::none;
    }
}

// A model takes each channel of base_color_* from itself or from the nearest entity above that gives it.
void SceneReader::inherit_base_colors() {
    std::vector<bool> is_done(scene_.entities.size(), false);
    std::vector<std::uint32_t> walk;
    for (std::uint32_t start = 0; start < scene_.entities.size(); ++start) {
        for (std::uint32_t at = start; at != Entity::none && !is_done[at]; at = scene_.entities[at].parent)
            walk.push_back(at);
        for (; !walk.empty(); walk.pop_back()) {
            const std::uint32_t at = walk.back(), up = scene_.entities[at].parent;
            is_done[at] = true;
            if (up == Entity::none) continue;
            for (std::size_t i = 0; i < 4; ++i)
                if (!base_colors_[at].channels[i]) base_colors_[at].channels[i] = base_colors_[up].channels[i];
        }
        Entity& entity = scene_.entities[start];
        const BaseColor& color = base_colors_[start];
        if (!entity.model || !color.is_given()) continue;
        if (!entity.material) entity.material.emplace();
        vec3 rgb = entity.material->color.value_or(vec3(1));
        for (int i = 0; i < 3; ++i) rgb[i] = color.channels[static_cast<std::size_t>(i)].value_or(rgb[i]);
        entity.material->color = rgb;
        if (color.channels[3]) entity.material->alpha = color.channels[3];
    }
}

namespace {

Result<Scene> scene_of_model(const std::filesystem::path& path, NamedFiles named_files) {
    DARKROOM_TRY(read_file(path, {.max_size = 1, .takes_start = true}));
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(path, error);
    Scene scene{.name = path.stem().string(),
                .file = path,
                .folder = path.parent_path(),
                .has_grid = false,
                .named_files = named_files};
    // Mid grey: nobody judges colours against blue.
    scene.environment.background = vec3(0.18F);
    scene.entities.push_back({.name = "model", .model = ModelReference{.asset = (error ? path : whole).string()}});
    return scene;
}

Result<Scene> scene_of(const toml::table& table, std::string_view text, const std::filesystem::path& file,
                       const SceneOptions& options) {
    DARKROOM_TRY_VALUE(Scene scene, SceneReader(table, file, options).read());
    scene.file_bytes += text.size();
    scene.named_files = options.named_files;
    return scene;
}

}  // namespace

bool is_scene(const toml::table& file) {
    constexpr std::array<std::string_view, 8> tables{"scene",     "camera",     "environment", "prefabs",
                                                     "templates", "archetypes", "entities",    "prefab"};
    return std::ranges::any_of(tables, [&](std::string_view key) { return file.contains(key); });
}

bool has_look(const toml::table& file) { return file.contains("post_process") || file.contains("stack"); }

}  // namespace reading

Result<Scene> parse_scene(std::string_view text, const std::filesystem::path& file, const SceneOptions& options) {
    const std::string shown = printable(file.string());
    DARKROOM_TRY_VALUE(const toml::table table, parse_toml(text, shown));
    return reading::scene_of(table, text, file, options);
}

bool is_model_path(const std::filesystem::path& path) {
    const std::string extension = lower(path.extension().string());
    return extension == ".glb" || extension == ".gltf";
}
bool is_scene_path(const std::filesystem::path& path) { return path.extension() == ".toml" || is_model_path(path); }

Result<Scene> read_scene(const std::filesystem::path& path, const SceneOptions& options) {
    const std::string extension = lower(path.extension().string());
    if (is_model_path(path)) return reading::scene_of_model(path, options.named_files);
    if (!extension.empty() && extension != ".toml")
        return user_error(
            fmt::format("{}: expected a scene (.toml) or a model (.glb, .gltf)", printable(path.string())));
    DARKROOM_TRY_VALUE(const std::string text, reading::read_scene_text(path));
    const std::string shown = printable(path.string());
    DARKROOM_TRY_VALUE(const toml::table table, parse_toml(text, shown));
    if (!reading::is_scene(table))
        return user_error(
            fmt::format("{}: is not a scene: it has no table [scene], [camera], [environment], [entities], "
                        "[prefabs], nor any other table of a scene{}",
                        shown, reading::has_look(table) ? "; a look is what --look takes" : ""));
    return reading::scene_of(table, text, path, options);
}

vec4 archetype_color(std::string_view archetype) {
    if (archetype == "room") return {0.27F, 0.53F, 1, 0.5F};
    if (archetype == "door") return {1, 0.53F, 0.27F, 1};
    if (archetype == "furniture") return {0.27F, 1, 0.53F, 1};
    if (archetype == "character") return {1, 1, 0.27F, 1};
    if (archetype == "wall") return {0.76F, 0.70F, 0.60F, 1};
    if (archetype == "floor") return {0.55F, 0.55F, 0.52F, 1};
    if (archetype == "ceiling") return {0.65F, 0.62F, 0.58F, 1};
    if (archetype == "pillar") return {0.70F, 0.65F, 0.55F, 1};
    return {0.8F, 0.8F, 0.8F, 1};
}

}  // namespace darkroom::scene
