// SPDX-License-Identifier: MIT
#pragma once
// A whole scene file to a Scene: the tables at its top, then its entities one by one, then who is whose parent.

#include <map>
#include <string>
#include <vector>

#include "scene/read/prefab_expand.hpp"
#include "scene/read/read_components.hpp"

namespace darkroom::scene::reading {

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
