// SPDX-License-Identifier: MIT
#pragma once
// The tables of scene files as a tree that can be merged: prefabs lay overrides over templates, archetypes lie under
// entities, and every value keeps the place it came from. Leaves point into the parsed files, which outlive the tree.

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "scene/read/read_report.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::scene::reading {

struct Member;

struct Value {
    const toml::node* node = nullptr;  ///< as the file has it; of a merged table: that of the lower layer
    Place place;
    std::string_view text;        ///< of a string, with its prefix put in
    std::vector<Member> members;  ///< of a table, sorted by key
    [[nodiscard]] bool is_table() const { return node != nullptr && node->is_table(); }
    [[nodiscard]] bool is_text() const { return node != nullptr && node->is_string(); }
};

struct Member {
    std::string_view key;
    Place place;
    Value value;
};

[[nodiscard]] const Value* find(const Value& table, std::string_view key);
/// How many values a table holds, at any depth.
[[nodiscard]] std::size_t member_count(const Value& table);
/// Lays `over` on `base`, table into table; anything else is replaced.
void merge(Value& base, const Value& over);
/// "1.5", "\"yes\"", "[1, 2, 3]", "a table".
[[nodiscard]] std::string show(const Value& value);

[[nodiscard]] inline Place place_of(const toml::source_region& source, std::uint32_t file) {
    return {file, source.begin.line, source.begin.column};
}

/// Makes trees, and owns the texts that prefixes were put into.
class TreeBuilder {
  public:
    explicit TreeBuilder(Report& report) : report_(report) {}
    /// `prefix` goes where the text has ${PREFIX}; null: texts stay as they are.
    [[nodiscard]] Value build(const toml::node& node, std::uint32_t file, const std::string* prefix = nullptr);
    /// Counts values that are copied; false, and an error, where that makes more than a scene may hold.
    [[nodiscard]] bool charge(std::size_t members, Place place);
    /// A copy of `text` that lives as long as the builder.
    [[nodiscard]] std::string_view keep(std::string text);

  private:
    [[nodiscard]] Value build(const toml::node& node, std::uint32_t file, const std::string* prefix, int depth);

    Report& report_;
    std::deque<std::string> texts_;
    std::size_t members_ = 0;
};

inline constexpr std::string_view prefix_mark = "${PREFIX}";
/// `text` with every ${PREFIX} replaced.
[[nodiscard]] std::string with_prefix(std::string_view text, std::string_view prefix);

}  // namespace darkroom::scene::reading
