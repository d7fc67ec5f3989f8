// SPDX-License-Identifier: MIT
#pragma once
// A whole scene file to a Scene: the tables at its top, then its entities one by one, then who is whose parent.

#include <array>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/named_files.hpp"
#include "scene/read/read_values.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene::reading {

// The components of an entity, each from its table [entities.NAME.<component>]. What a component means is said in
// scene.hpp; this is only which keys it has and what they may hold.

/// material.base_color_r and so on: they colour the models of an entity and of all below it.
struct BaseColor {
    std::array<std::optional<float>, 4> channels;
    [[nodiscard]] bool is_given() const { return channels[0] || channels[1] || channels[2] || channels[3]; }
};

struct EntityDraft {
    Entity entity;
    BaseColor base_color;
};

struct ComponentReader {
    std::string_view name;
    void (*read)(TableReader& table, EntityDraft& draft);
};
/// Null for a component that means nothing here.
[[nodiscard]] const ComponentReader* find_component(std::string_view name);
[[nodiscard]] std::span<const ComponentReader> all_components();

void read_camera(TableReader& table, Camera& camera);
void read_environment(TableReader& table, Environment& environment);

// Which entities a scene has: those of its [entities], and those that its [prefabs] bring in from templates, in the
// order of the file. Nothing is read of them here but names, parents and how tables lie on each other.
//
//     [prefabs.left]                            a template is a file, prefabs/lamp.prefab.toml beside the scene or one
//     template = "lamp"                         folder up, any path that ends in .toml, or [templates.lamp] of the file
//     prefix = "left"                           that names it; it holds [entities.*] and may hold [prefabs.*]
//     overrides.bulb.light.intensity = 4
//
// The entity "bulb" of the template becomes "left_bulb", or what ${PREFIX} in its name says; a parent that is of the
// template is renamed alike.

struct RawEntity {
    std::string name;
    Place place;
    Value table;
    const toml::table* archetypes = nullptr;  ///< of the file that the entity stands in
};

/// What entities are taken from: a file, or a table of one.
struct Level {
    std::uint32_t file = 0;
    std::filesystem::path folder;  ///< of the file
    const toml::table* table = nullptr;
    const toml::table* templates = nullptr;   ///< [templates] of the file
    const toml::table* archetypes = nullptr;  ///< [archetypes] of the file
};

/// That of a whole file.
[[nodiscard]] Level level_of(const toml::table& table, std::uint32_t file, std::filesystem::path folder);

inline constexpr std::size_t max_entities = 100'000;

/// Files of prefabs, kept since the trees point into them.
struct LoadedFile {
    std::string identity;  ///< the same for all names of a file
    toml::table table;
    Level level;
};

class PrefabExpander {
  public:
    PrefabExpander(Report& report, TreeBuilder& trees, std::filesystem::path scene_folder, NamedFiles named_files)
        : report_(report), trees_(trees), scene_folder_(std::move(scene_folder)), named_files_(named_files) {}
    PrefabExpander(const PrefabExpander&) = delete;
    PrefabExpander& operator=(const PrefabExpander&) = delete;
    [[nodiscard]] std::vector<RawEntity> expand(const Level& scene);

    /// Of the prefabs that were read.
    [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }
    /// A limit was passed, and an error reported: the rest of the scene is not expanded.
    [[nodiscard]] bool is_full() const { return is_full_; }

  private:
    struct Instance {
        std::string name;  // of the table
        std::string template_name;
        Place template_place;
        std::string prefix;
        Value overrides;
    };
    struct Template {
        std::string identity;  // what a cycle is noticed by
        std::string shown;
        Level level;
    };

    void expand_level(const Level& level, const std::string* prefix);
    void add_entity(const Level& level, const toml::key& key, const toml::node& node, const std::string* prefix);
    void expand_instance(const Level& level, const toml::key& key, const toml::node& node, const std::string* prefix);
    void apply_overrides(const Instance& instance, std::size_t first);
    [[nodiscard]] std::optional<Instance> read_instance(const Level& level, const toml::key& key,
                                                        const toml::node& node, const std::string* prefix);
    [[nodiscard]] std::optional<Template> find_template(const Level& level, const Instance& instance);
    [[nodiscard]] LoadedFile* load(const std::filesystem::path& path, const Instance& instance);
    [[nodiscard]] const toml::table* table_of(const Level& level, std::string_view key);
    /// Templates and archetypes are tables of tables, used or not.
    void check_tables(const Level& level);

    Report& report_;
    TreeBuilder& trees_;
    std::filesystem::path scene_folder_;
    NamedFiles named_files_;
    std::deque<LoadedFile> files_;
    std::vector<RawEntity> entities_;
    std::unordered_map<std::string, std::size_t> names_;
    std::vector<Template> chain_;
    std::size_t instances_ = 0;
    std::uint64_t file_bytes_ = 0;
    bool is_full_ = false;
};

class SceneReader {
  public:
    SceneReader(const toml::table& file, const std::filesystem::path& path, const SceneOptions& options);
    [[nodiscard]] Result<Scene> read();

  private:
    struct ParentName {
        std::string name;
        Place place;
    };
    struct UnknownComponent {
        Place place;
        std::size_t count = 0;
    };
    struct Archetype {
        Value tree;
        std::size_t size = 0;
    };

    void read_top();
    [[nodiscard]] Value table_at(std::string_view key);
    void expect_table(std::string_view key, const toml::node& node);
    void read_scene_table(const Value& value);
    void read_entity(const RawEntity& raw);
    void read_member(const Member& member, const Where& where, EntityDraft& draft);
    [[nodiscard]] Value with_archetype(const RawEntity& raw, const std::string& archetype);
    void report_unknown_components();
    void link_parents();
    void report_cycles();
    void inherit_base_colors();

    const toml::table& file_;
    const SceneOptions& options_;
    Report report_;
    TreeBuilder trees_{report_};
    Reader reader_{.report = report_, .trees = trees_};
    Scene scene_;
    std::vector<ParentName> parents_;     // one for each entity
    std::vector<BaseColor> base_colors_;  // one for each entity
    std::map<std::string, UnknownComponent, std::less<>> unknown_;
    std::map<const toml::node*, Archetype> archetypes_;
};

}  // namespace darkroom::scene::reading
