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

struct Found {
    const EffectFile* file = nullptr;
    std::string shown;
    bool is_shared = false;
    bool has_forms = false;
};
/// Names of a user's files have no dot, so that they have one form.
Found find(const EffectInfo& info, std::string_view name, bool is_software) {
    const std::string software = fmt::format("{}.software.glsl", name.substr(0, name.rfind('.')));
    for (const auto files : {info.files, shared_files()}) {
        const EffectFile* const other = find_file(files, software);
        const EffectFile* const file = is_software && other != nullptr ? other : find_file(files, name);
        if (file == nullptr) continue;
        const bool is_shared = files.data() != info.files.data();
        std::string shown =
            is_shared ? fmt::format("effects/{}", file->name) : fmt::format("effects/{}/{}", info.name, file->name);
        if (!file->shown.empty()) shown = file->shown;
        return {file, std::move(shown), is_shared, other != nullptr};
    }
    return {.file = nullptr, .shown = fmt::format("effects/{}/{}", info.name, name)};
}

/// Lines that include a file of the effect's own folder, or one with two forms, replaced by it.
std::string with_own_files(const EffectInfo& info, const Found& from, bool is_software, int depth = 0) {
    std::string out;
    for_each_line(from.file->text, [&](std::string_view line, std::size_t number) {
        const std::string_view name = included_name(line);
        const Found included = name.empty() ? Found{} : find(info, name, is_software);
        const bool is_own = included.file != nullptr && (!included.is_shared || included.has_forms);
        if (!is_own || depth > deepest_include)
            out.append(line).push_back('\n');
        else
            out += fmt::format("#line 1 \"{}\"\n{}\n#line {} \"{}\"\n", included.shown,
                               with_own_files(info, included, is_software, depth + 1), number + 1, from.shown);
    });
    return out;
}

}  // namespace

OwnText own_text(const EffectInfo& info, std::string_view name, bool is_software) {
    Found found = find(info, name, is_software);
    std::string glsl = found.file == nullptr ? std::string() : with_own_files(info, found, is_software);
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
