// SPDX-License-Identifier: MIT
#include "scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include "core/lies_in.hpp"
#include "core/text/param_text.hpp"
#include "scene/read/scene_file.hpp"

namespace darkroom::scene::reading {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_instances = 10'000, deepest_chain = 16, longest_prefix = 256, longest_name = 1024;

std::string qualified(std::string_view name, std::string_view prefix) {
    if (name.find(prefix_mark) != std::string_view::npos) return with_prefix(name, prefix);
    return fmt::format("{}_{}", prefix, name);
}

}  // namespace

Level level_of(const toml::table& table, std::uint32_t file, fs::path folder) {
    return {.file = file,
            .folder = std::move(folder),
            .table = &table,
            .templates = table["templates"].as_table(),
            .archetypes = table["archetypes"].as_table()};
}

std::vector<RawEntity> PrefabExpander::expand(const Level& scene) {
    check_tables(scene);
    expand_level(scene, nullptr);
    return std::move(entities_);
}

const toml::table* PrefabExpander::table_of(const Level& level, std::string_view key) {
    const toml::node* const node = level.table->get(key);
    if (node == nullptr || node->is_table()) return node == nullptr ? nullptr : node->as_table();
    report_.error(place_of(node->source(), level.file),
                  [&] { return fmt::format("{} = {}: expected a table", key, darkroom::show(*node)); });
    return nullptr;
}

void PrefabExpander::check_tables(const Level& level) {
    for (const std::string_view key : {"templates", "archetypes"}) {
        const toml::table* const table = table_of(level, key);
        if (table == nullptr) continue;
        for (const auto& [name, node] : *table)
            if (!node.is_table())
                report_.error(place_of(node.source(), level.file), [&, &shown = name, &value = node] {
                    return fmt::format("{}.{} = {}: expected a table", key, printable(shown.str()),
                                       darkroom::show(value));
                });
    }
}

// Tables are sorted by name, files are not: the place of the key that first names an entity gives its rank.
void PrefabExpander::expand_level(const Level& level, const std::string* prefix) {
    struct Item {
        const toml::key* key;
        const toml::node* node;
        bool is_instance;
    };
    std::vector<Item> items;
    for (const bool is_instance : {false, true})
        if (const toml::table* const table = table_of(level, is_instance ? "prefabs" : "entities"))
            for (const auto& [key, node] : *table) items.push_back({&key, &node, is_instance});
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.key->source().begin < b.key->source().begin; });
    for (const Item& item : items) {
        if (is_full_) return;
        if (item.is_instance)
            expand_instance(level, *item.key, *item.node, prefix);
        else
            add_entity(level, *item.key, *item.node, prefix);
    }
}

void PrefabExpander::add_entity(const Level& level, const toml::key& key, const toml::node& node,
                                const std::string* prefix) {
    const Place place = place_of(key.source(), level.file);
    if (entities_.size() == max_entities) {
        is_full_ = true;
        report_.error(place, [] { return fmt::format("the scene has more than {} entities", max_entities); });
        return;
    }
    RawEntity raw{.name = prefix == nullptr ? std::string(key.str()) : qualified(key.str(), *prefix),
                  .place = place,
                  .archetypes = level.archetypes};
    if (raw.name.empty() || raw.name.size() > longest_name)
        return report_.error(place, [&] {
            return fmt::format("entity '{}': a name has [1, {}] bytes", printable(raw.name), longest_name);
        });
    const auto known = names_.try_emplace(raw.name, entities_.size());
    if (!known.second)
        return report_.error(place, [&] {
            return fmt::format("entity '{}' is there already, from {}", printable(raw.name),
                               report_.show(entities_[known.first->second].place));
        });
    raw.table = trees_.build(node, level.file, prefix);
    if (prefix != nullptr)
        for (Member& member : raw.table.members) {
            if (member.key != "parent" || !member.value.is_text()) continue;
            const std::string& parent = member.value.node->as_string()->get();
            if (parent.find(prefix_mark) == std::string::npos && (*level.table)["entities"][parent])
                member.value.text = trees_.keep(qualified(parent, *prefix));
        }
    entities_.push_back(std::move(raw));
}

std::optional<PrefabExpander::Instance> PrefabExpander::read_instance(const Level& level, const toml::key& key,
                                                                      const toml::node& node,
                                                                      const std::string* prefix) {
    Instance out{.name = std::string(key.str())};
    const Place place = place_of(key.source(), level.file);
    const std::string shown = fmt::format("prefabs.{}", printable(out.name));
    if (!node.is_table()) {
        report_.error(place, [&] { return fmt::format("{} = {}: expected a table", shown, darkroom::show(node)); });
        return std::nullopt;
    }
    Reader reader{.report = report_, .trees = trees_};
    const Value own = trees_.build(node, level.file);
    const Where up{.name = "prefabs"}, where{.up = &up, .name = out.name};
    TableReader table(reader, own, where);
    const bool is_named = table.text("template", out.template_name) || !table.has("template");
    out.prefix = out.name;
    table.text("prefix", out.prefix);
    if (prefix != nullptr) out.prefix = qualified(out.prefix, *prefix);
    table.pass_over("overrides");
    table.finish();
    if (!is_named) return std::nullopt;  // a value of another kind has been reported
    if (out.template_name.empty()) {
        report_.error(place, [&] { return fmt::format("{}.template is missing: the name of a template", shown); });
        return std::nullopt;
    }
    if (out.prefix.empty() || out.prefix.size() > longest_prefix) {
        report_.error(place, [&] {
            return fmt::format("{}.prefix = \"{}\": allowed are [1, {}] bytes", shown, printable(out.prefix),
                               longest_prefix);
        });
        return std::nullopt;
    }
    out.template_place = table.place_of_value("template");
    if (const toml::node* const overrides = node.as_table()->get("overrides"))
        out.overrides = trees_.build(*overrides, level.file, prefix != nullptr ? prefix : &out.prefix);
    return out;
}

void PrefabExpander::expand_instance(const Level& level, const toml::key& key, const toml::node& node,
                                     const std::string* prefix) {
    const Place place = place_of(key.source(), level.file);
    if (++instances_ > max_instances) {
        is_full_ = true;
        report_.error(place, [] { return fmt::format("the scene has more than {} prefabs", max_instances); });
        return;
    }
    const std::optional<Instance> instance = read_instance(level, key, node, prefix);
    if (!instance) return;
    std::optional<Template> found = find_template(level, *instance);
    if (!found) return;
    const auto again = std::find_if(chain_.begin(), chain_.end(),
                                    [&](const Template& above) { return above.identity == found->identity; });
    if (again != chain_.end() || chain_.size() == deepest_chain)
        return report_.error(instance->template_place, [&] {
            std::vector<std::string> names;
            for (auto above = again == chain_.end() ? chain_.begin() : again; above != chain_.end(); ++above)
                names.push_back(printable(above->shown));
            names.push_back(printable(found->shown));
            return fmt::format("prefabs.{}.template = \"{}\": {}: {}", printable(instance->name),
                               printable(instance->template_name),
                               again != chain_.end() ? "prefabs hold themselves"
                                                     : fmt::format("prefabs go deeper than {}", deepest_chain),
                               fmt::join(names, " -> "));
        });
    const std::size_t first = entities_.size();
    const Level inner = found->level;
    chain_.push_back(std::move(*found));
    expand_level(inner, &instance->prefix);
    chain_.pop_back();
    apply_overrides(*instance, first);
}

void PrefabExpander::apply_overrides(const Instance& instance, std::size_t first) {
    if (instance.overrides.node == nullptr) return;
    const std::string shown = fmt::format("prefabs.{}.overrides", printable(instance.name));
    if (!instance.overrides.is_table())
        return report_.error(instance.overrides.place,
                             [&] { return fmt::format("{} = {}: expected a table", shown, show(instance.overrides)); });
    for (const Member& member : instance.overrides.members) {
        auto found = names_.find(qualified(member.key, instance.prefix));
        if (found == names_.end()) found = names_.find(std::string(member.key));
        if (found != names_.end() && found->second >= first) {
            merge(entities_[found->second].table, member.value);
            continue;
        }
        report_.slip(member.place, [&] {
            std::vector<std::string> names;
            for (std::size_t i = first; i < entities_.size() && names.size() < 100; ++i)
                names.push_back(entities_[i].name);
            return fmt::format("{}.{}: the template \"{}\" has no such entity{}", shown, printable(member.key),
                               printable(instance.template_name),
                               report_.suggestion(qualified(member.key, instance.prefix), names));
        });
    }
}

std::optional<PrefabExpander::Template> PrefabExpander::find_template(const Level& level, const Instance& instance) {
    const std::string& name = instance.template_name;
    const toml::node* const own = level.templates == nullptr ? nullptr : level.templates->get(name);
    if (own != nullptr) {
        if (!own->is_table()) return std::nullopt;  // check_tables has said so
        Level inner = level;
        inner.table = own->as_table();
        return Template{.identity = fmt::format("{}:{}", level.file, name), .shown = name, .level = inner};
    }
    std::vector<fs::path> places;
    if (name.ends_with(".toml")) {
        places = {level.folder / name, scene_folder_ / name};
    } else {
        const std::string file = name + ".prefab.toml";
        places = {scene_folder_ / "prefabs" / file, scene_folder_ / ".." / "prefabs" / file};
    }
    for (const fs::path& path : places) {
        std::error_code error;
        if (!fs::exists(path, error)) continue;
        const bool is_own = lies_in(scene_folder_, path) || lies_in(scene_folder_ / ".." / "prefabs", path);
        if (named_files_ == NamedFiles::Own && !is_own) {
            report_.error(instance.template_place, [&] {
                return fmt::format("prefabs.{}.template = \"{}\": leaves the folder of the scene",
                                   printable(instance.name), printable(name));
            });
            return std::nullopt;
        }
        const LoadedFile* const file = load(path.lexically_normal(), instance);
        if (file == nullptr) return std::nullopt;
        return Template{.identity = file->identity, .shown = name, .level = file->level};
    }
    report_.error(instance.template_place, [&] {
        std::vector<std::string> names;
        if (level.templates != nullptr)
            for (const auto& [key, node] : *level.templates)
                if (names.size() < 100) names.emplace_back(key.str());
        return fmt::format("prefabs.{}.template = \"{}\": there is neither a table [templates.{}] nor a file {}{}",
                           printable(instance.name), printable(name), printable(name),
                           printable(places.front().lexically_normal().string()), report_.suggestion(name, names));
    });
    return std::nullopt;
}

LoadedFile* PrefabExpander::load(const fs::path& path, const Instance& instance) {
    std::error_code error;
    fs::path whole = fs::weakly_canonical(path, error);
    const std::string identity = (error ? path : whole).string();
    for (LoadedFile& file : files_)
        if (file.identity == identity) return file.level.table == nullptr ? nullptr : &file;
    LoadedFile& file = files_.emplace_back(LoadedFile{.identity = identity});
    const std::string shown = printable(path.string());
    const Result<std::string> text = read_scene_text(path);
    if (text) file_bytes_ += text->size();
    Result<toml::table> table = text ? parse_toml(*text, shown) : Result<toml::table>(failure(text.error()));
    if (!table) {
        report_.error(instance.template_place, [&] {
            return fmt::format("prefabs.{}.template = \"{}\": {}", printable(instance.name),
                               printable(instance.template_name), table.error().text);
        });
        return nullptr;
    }
    file.table = std::move(*table);
    file.level = level_of(file.table, report_.add_file(shown), path.parent_path());
    check_tables(file.level);
    return &file;
}

}  // namespace darkroom::scene::reading
