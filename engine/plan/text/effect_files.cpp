// SPDX-License-Identifier: MIT
#include "plan/text/effect_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace darkroom::plan {

namespace {

constexpr int deepest_include = 8;

const EffectFile* find_file(std::span<const EffectFile> files, std::string_view name) {
    const auto found = std::ranges::find(files, name, &EffectFile::name);
    return found == files.end() ? nullptr : &*found;
}

/// The name in a line `#include "NAME"`, else nothing.
std::string_view included_name(std::string_view line) {
    constexpr std::string_view directive = "#include \"";
    if (!line.starts_with(directive)) return {};
    return line.substr(directive.size(), line.rfind('"') - directive.size());
}

/// Calls visit(line, number) for each line, without its end.
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
    std::size_t number = 1;
    for (std::size_t i = 0; i < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', i), text.size());
        visit(text.substr(i, end - i), number);
        i = end + 1;
    }
}

constexpr std::string_view part_mark = "#part";

/// Lines of other parts are empty, so that each line keeps its number.
std::string part_of(std::string_view text, std::string_view part) {
    std::string out;
    bool is_in = true;
    for_each_line(text, [&](std::string_view line, std::size_t) {
        const bool is_mark = line.starts_with(part_mark);
        if (is_mark) {
            const std::string names = fmt::format("{} ", line.substr(part_mark.size()));
            is_in = names == " " || names.find(fmt::format(" {} ", part)) != std::string::npos;
        } else if (is_in) {
            out += line;
        }
        out += '\n';
    });
    return out;
}

struct Found {
    const EffectFile* file = nullptr;
    std::string shown;
    bool is_shared = false;
};
Found find(const EffectInfo& info, std::string_view name) {
    for (const auto files : {info.files, shared_files()}) {
        const EffectFile* const file = find_file(files, name);
        if (file == nullptr) continue;
        const bool is_shared = files.data() != info.files.data();
        std::string shown =
            is_shared ? fmt::format("effects/{}", file->name) : fmt::format("effects/{}/{}", info.name, file->name);
        if (!file->shown.empty()) shown = file->shown;
        return {file, std::move(shown), is_shared};
    }
    return {.file = nullptr, .shown = fmt::format("effects/{}/{}", info.name, name)};
}

/// Lines that include a file of the effect's own folder replaced by it.
std::string with_own_files(const EffectInfo& info, const Found& from, std::string_view part, int depth = 0) {
    std::string out;
    for_each_line(part_of(from.file->text, part), [&](std::string_view line, std::size_t number) {
        const std::string_view name = included_name(line);
        const Found included = name.empty() ? Found{} : find(info, name);
        const bool is_own = included.file != nullptr && !included.is_shared;
        if (!is_own || depth > deepest_include)
            out.append(line).push_back('\n');
        else
            out += fmt::format("#line 1 \"{}\"\n{}\n#line {} \"{}\"\n", included.shown,
                               with_own_files(info, included, part, depth + 1), number + 1, from.shown);
    });
    return out;
}

}  // namespace

OwnText own_text(const EffectInfo& info, std::string_view name) {
    const std::size_t mark = std::min(name.find('#'), name.size());
    Found found = find(info, name.substr(0, mark));
    const std::string_view part = mark == name.size() ? "end" : name.substr(mark + 1);
    std::string glsl = found.file == nullptr ? std::string() : with_own_files(info, found, part);
    return {std::move(glsl), std::move(found.shown)};
}

Result<void> append_with_includes(std::string& out, std::string_view text, const std::string& shown, int depth) {
    out += fmt::format("#line 1 \"{}\"\n", shown);
    Result<void> result;
    for_each_line(text, [&](std::string_view line, std::size_t number) {
        const std::string_view name = included_name(line);
        if (!result) return;
        if (name.empty()) {
            out.append(line).push_back('\n');
            return;
        }
        const EffectFile* const included = find_file(shared_files(), name);
        if (included == nullptr || depth > deepest_include) {
            result = user_error(
                fmt::format("{}:{}: #include \"{}\": there is no such file in effects/shared", shown, number, name));
            return;
        }
        result = append_with_includes(out, included->text, fmt::format("effects/{}", name), depth + 1);
        out += fmt::format("#line {} \"{}\"\n", number + 1, shown);
    });
    return result;
}

}  // namespace darkroom::plan
