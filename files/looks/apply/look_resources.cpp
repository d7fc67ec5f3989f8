// SPDX-License-Identifier: MIT
#include "looks/apply/look_resources.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "tables/cube_file.hpp"

namespace darkroom {

namespace {

std::size_t count_of(const ResourceData& data) {
    if (const auto* const image = std::get_if<ResourceImage>(&data)) return image->rgba.size();
    const ColorTable& table = std::get<ColorTable>(data);
    return table.shaper.size() + table.cube.size();
}

}  // namespace

bool is_file_name(std::string_view wire) {
    const std::size_t dot = wire.find('.');
    return dot != std::string_view::npos && wire.substr(dot) != previous_suffix;
}

Result<> ResourceFiles::put(LookEntry& entry, const ParamInfo& row, const std::string& name) {
    return put(entry, row.name, name, row.is_picture ? FileUse::Numbers : FileUse::Table);
}

Result<> ResourceFiles::put(LookEntry& entry, const WireInfo& wire, const std::string& name) {
    DARKROOM_TRY(put(entry, wire.key, is_file_name(name) ? name : std::string(), wire.use));
    entry.*wire.member = name;
    return {};
}

Result<> ResourceFiles::put(LookEntry& entry, std::string_view parameter, const std::string& file, FileUse use) {
    std::erase_if(entry.resources, [&](const LookResource& one) { return one.parameter == parameter; });
    if (!file.empty()) {
        DARKROOM_TRY_VALUE(const auto loaded, load((folder_ / file).lexically_normal(), use));
        entry.resources.push_back({std::string(parameter), file, loaded});
    }
    for (const ParamInfo& row : entry.effect->parameters.rows) {
        if (row.kind != Kind::Resource) continue;
        const auto found = std::ranges::find(entry.resources, row.name, &LookResource::parameter);
        const bool is_there = found != entry.resources.end();
        entry.words[row.word] = is_there ? static_cast<std::uint32_t>(found - entry.resources.begin() + 1) : 0;
    }
    return {};
}

Result<std::shared_ptr<const ResourceData>> ResourceFiles::load(const std::filesystem::path& path, FileUse use) {
    if (const auto found = loaded_.find({path, use}); found != loaded_.end()) return found->second;
    // The first that is too much is told; those behind it are not read.
    if (numbers_ > options_.max_resource_numbers)
        return user_error(
            fmt::format("{}: is not read: the look's other tables and pictures hold as many numbers as are allowed",
                        printable(path.string())));
    const auto read = [&]() -> Result<ResourceData> {
        if (options_.load_resource) return options_.load_resource(path, use);
        if (use != FileUse::Table)
            return user_error(fmt::format("{}: this program reads no pictures for looks", printable(path.string())));
        if (!options_.reads_tables)
            return user_error(fmt::format("{}: this program reads no tables for looks", printable(path.string())));
        DARKROOM_TRY_VALUE(TableFile file, read_cube(path));
        return ResourceData(std::move(file.table));
    };
    DARKROOM_TRY_VALUE(ResourceData data, read());
    numbers_ += count_of(data);
    if (numbers_ > options_.max_resource_numbers)
        return user_error(
            fmt::format("{}: with it, the look's tables and pictures hold {} numbers, at most {} are allowed",
                        printable(path.string()), numbers_, options_.max_resource_numbers));
    return loaded_[{path, use}] = std::make_shared<const ResourceData>(std::move(data));
}

const LookResource* resource_of(const LookEntry& entry, const ParamInfo& row) {
    const std::uint32_t number = row.kind == Kind::Resource ? entry.words[row.word] : 0;
    return number == 0 || number > entry.resources.size() ? nullptr : &entry.resources[number - 1];
}

const LookResource* resource_of(const LookEntry& entry, const WireInfo& wire) {
    if (!is_file_name(entry.*wire.member)) return nullptr;
    const auto found = std::ranges::find(entry.resources, wire.key, &LookResource::parameter);
    return found == entry.resources.end() ? nullptr : &*found;
}

std::string toml_string(std::string_view text) {
    std::string out(1, '"');
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out.append(1, '\\').append(1, c);
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + '"';
}

std::string game_text(const GameValue& value) {
    const auto* const text = std::get_if<std::string>(&value);
    if (text != nullptr) return toml_string(*text);
    const auto* const number = std::get_if<double>(&value);
    return number != nullptr ? fmt::format("{}", *number) : fmt::format("{}", std::get<bool>(value));
}

std::string game_text(const GameTable& game) {
    if (game.empty()) return {};
    std::vector<std::string> values;
    for (const auto& [name, value] : game)
        values.push_back(fmt::format("{} = {}", toml_string(name), game_text(value)));
    return fmt::format("{{ {} }}", fmt::join(values, ", "));
}

std::string list_text(std::span<const std::string> names) {
    if (names.empty()) return {};
    std::vector<std::string> texts;
    for (const std::string& name : names) texts.push_back(toml_string(name));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string value_text(const LookEntry& entry, const ParamInfo& row) {
    if (row.kind != Kind::Resource) {
        // Where sizes are parts of the height anyway, plain numbers say the same.
        const std::span defaults = entry.effect->parameters.defaults;
        const bool is_own =
            row.reach_word < defaults.size() && defaults[row.reach_word] != static_cast<std::uint32_t>(Reach::Height);
        return is_own ? format_for_file(row, entry.words) : format(row, entry.words);
    }
    const LookResource* const resource = resource_of(entry, row);
    return toml_string(resource == nullptr ? std::string_view() : resource->file);
}

}  // namespace darkroom
