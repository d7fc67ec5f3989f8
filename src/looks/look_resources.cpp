// SPDX-License-Identifier: MIT
#include "looks/look_resources.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/param_text.hpp"
#include "tables/cube_file.hpp"

namespace darkroom {

namespace {

std::size_t count_of(const ResourceData& data) {
    if (const auto* const image = std::get_if<ResourceImage>(&data)) return image->rgba.size();
    const ColorTable& table = std::get<ColorTable>(data);
    return table.shaper.size() + table.cube.size();
}

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f')
            out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + '"';
}

}  // namespace

Result<> ResourceFiles::put(LookEntry& entry, const ParamInfo& row, const std::string& name) {
    std::erase_if(entry.resources, [&](const LookResource& one) { return one.parameter == row.name; });
    std::shared_ptr<const ResourceData> data;
    if (!name.empty()) {
        const auto loaded = load((folder_ / name).lexically_normal());
        if (!loaded) return failure(loaded.error());
        data = *loaded;
        entry.resources.push_back({std::string(row.name), name, data});
    }
    entry.words[row.word] = 0;
    for (std::size_t i = 0; i < entry.resources.size(); ++i) {
        const ParamInfo* const other = entry.effect->parameters.find(entry.resources[i].parameter);
        if (other != nullptr) entry.words[other->word] = static_cast<std::uint32_t>(i + 1);
    }
    return {};
}

Result<std::shared_ptr<const ResourceData>> ResourceFiles::load(const std::filesystem::path& path) {
    if (const auto found = loaded_.find(path); found != loaded_.end()) return found->second;
    const auto read = [&]() -> Result<ResourceData> {
        if (options_.load_resource) return options_.load_resource(path);
        Result<TableFile> file = read_cube(path);
        if (!file) return failure(std::move(file));
        return ResourceData(std::move(file->table));
    };
    Result<ResourceData> data = read();
    if (!data) return failure(std::move(data));
    numbers_ += count_of(*data);
    if (numbers_ > options_.most_resource_numbers)
        return user_error(fmt::format("{}: the look's tables and pictures hold {} numbers with it, allowed are {}",
                                      printable(path.string()), numbers_, options_.most_resource_numbers));
    return loaded_[path] = std::make_shared<const ResourceData>(std::move(*data));
}

const LookResource* resource_of(const LookEntry& entry, const ParamInfo& row) {
    const std::uint32_t number = row.kind == Kind::Resource ? entry.words[row.word] : 0;
    return number == 0 || number > entry.resources.size() ? nullptr : &entry.resources[number - 1];
}

std::string value_text(const LookEntry& entry, const ParamInfo& row) {
    if (row.kind != Kind::Resource) return format(row, entry.words);
    const LookResource* const resource = resource_of(entry, row);
    return quoted(resource == nullptr ? std::string_view() : resource->file);
}

}  // namespace darkroom
