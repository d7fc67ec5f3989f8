// SPDX-License-Identifier: MIT
#include "edit/splice/list_blocks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace darkroom::edit {

namespace {

/// A block such as [[stack]]: its comments, its header, its keys, up to the end of its last line; and what stands
/// between it and what comes next.
struct Block {
    std::size_t begin = 0, end = 0, next = 0;
    std::string text, gap;
    bool is_followed = false;  ///< by another block
};

class Blocks {
  public:
    Blocks(TomlEditor& editor, std::string_view key)
        : editor_(editor), key_(key), path_{std::string(key)}, text_(editor.text()) {}

    Result<> arrange(std::span<const ListElement> elements) {
        DARKROOM_TRY(find());
        const std::string eol(editor_.line_end());
        std::vector<Block> now;
        for (const ListElement& element : elements) {
            now.push_back(element.now
                              ? blocks_[*element.now]
                              : Block{.text = block_of(key_, element, eol), .gap = eol + eol, .is_followed = true});
            // What stands behind the last of a row of blocks is not its own.
            if (!now.back().is_followed) now.back().gap = eol + eol;
        }
        std::string out(text_.substr(0, blocks_.front().begin));
        std::size_t k = 0;
        for (std::size_t i = 0; i < blocks_.size();) {
            std::size_t last = i;
            while (blocks_[last].is_followed) ++last;
            const bool is_end = last + 1 == blocks_.size();
            const std::size_t end = is_end ? now.size() : std::min(now.size(), k + last + 1 - i);
            const std::size_t first = k;
            for (; k < end; ++k) out += now[k].text + (k + 1 < end ? now[k].gap : std::string());
            // A removed row takes its gap along.
            if (k > first) out += blocks_[last].gap;
            const std::size_t rest = is_end ? text_.size() : blocks_[last + 1].begin;
            out += text_.substr(blocks_[last].next, rest - blocks_[last].next);
            i = last + 1;
        }
        // Behind the last of a text nothing has to be kept apart.
        if (elements.empty() && blocks_.back().next == text_.size())
            while (out.ends_with(eol + eol)) out.erase(out.size() - eol.size());
        return editor_.replace(0, text_.size(), out);
    }

    static std::string block_of(std::string_view key, const ListElement& element, std::string_view eol) {
        std::string out = fmt::format("[[{}]]", key);
        for (const std::string& pair : element.pairs) out.append(eol).append(pair);
        return out;
    }

  private:
    /// Where the comments right above a line begin; those at the head of the text are the text's. `floor`: where the
    /// line behind all that stands before begins.
    [[nodiscard]] std::size_t with_comments(std::size_t line, std::size_t floor) const {
        std::size_t out = line;
        while (out > floor) {
            const std::size_t above = editor_.line_begin(out - 1);
            if (text_[text_.find_first_not_of(" \t", above)] != '#') return out;
            out = above;
        }
        return floor == editor_.line_begin(0) ? line : out;
    }
    /// Behind the comments right below a line, unless they are right above what comes next.
    [[nodiscard]] std::size_t with_comments_below(std::size_t end, std::size_t next) const {
        while (end < next) {
            const std::size_t first = text_.find_first_not_of(" \t", end);
            if (first == std::string_view::npos || text_[first] != '#') break;
            end = editor_.line_end_at(first);
        }
        return end;
    }

    [[nodiscard]] bool is_block(const TomlItem& item) const {
        return item.kind == TomlItem::Kind::ArrayTable && item.path.size() == 2 && item.path[0] == key_;
    }

    Result<> find() {
        const std::vector<TomlItem>& items = editor_.items();
        std::size_t end = 0, known = 0;
        const auto begin_of = [&](const TomlItem& item) {
            return with_comments(editor_.line_begin(item.begin),
                                 end == 0 ? editor_.line_begin(0) : editor_.line_end_at(end));
        };
        for (std::size_t i = 0, next = 1; i < items.size(); i = next++) {
            if (!is_block(items[i])) {
                end = std::max(end, items[i].end);
                continue;
            }
            Block block{.begin = begin_of(items[i]), .next = text_.size()};
            while (next < items.size() && is_within(items[next].path, items[i].path)) ++next;
            known += next - i;
            for (std::size_t k = i; k < next; ++k) end = std::max(end, items[k].end);
            if (next < items.size()) block.next = begin_of(items[next]);
            block.is_followed = next < items.size() && is_block(items[next]);
            const std::size_t line = with_comments_below(editor_.line_end_at(end), block.next);
            block.end = text_.find_last_not_of("\r\n", line - 1) + 1;
            block.text = text_.substr(block.begin, block.end - block.begin);
            block.gap = text_.substr(block.end, block.next - block.end);
            blocks_.push_back(std::move(block));
        }
        const auto all =
            std::ranges::count_if(items, [&](const TomlItem& item) { return is_within(item.path, path_); });
        if (blocks_.empty() || known != static_cast<std::size_t>(all))
            return user_error(fmt::format(
                "{0}: its entries are not whole blocks [[{0}]] of the text, so none can be moved, added or taken out "
                "there",
                key_));
        return {};
    }

    TomlEditor& editor_;
    std::string_view key_;
    TomlPath path_;
    std::string_view text_;
    std::vector<Block> blocks_;
};

/// The same for `stack = [{ ... }, { ... }]`.
Result<> arrange_inline(TomlEditor& editor, const TomlItem& array, std::span<const ListElement> elements) {
    const std::string_view text = editor.text();
    std::vector<std::pair<std::size_t, std::size_t>> now;
    for (const TomlItem& item : editor.items())
        if (item.path.size() == 2 && is_within(item.path, array.path)) now.emplace_back(item.value_begin, item.end);
    // What stands in front of the first, between two, and behind the last.
    std::string lead, tail, between = ", ";
    if (!now.empty()) {
        lead = text.substr(array.value_begin + 1, now.front().first - array.value_begin - 1);
        tail = text.substr(now.back().second, array.end - 1 - now.back().second);
        if (now.size() > 1) between = text.substr(now[0].second, now[1].first - now[0].second);
    }
    if ((lead + tail + between).find('#') != std::string::npos)
        return user_error(fmt::format(
            "{}: its list holds comments, so entries cannot be moved, added or taken out there", array.path[0]));
    std::string out = "[" + lead;
    for (const ListElement& element : elements) {
        if (&element != elements.data()) out += between;
        if (element.now)
            out += text.substr(now[*element.now].first, now[*element.now].second - now[*element.now].first);
        else
            out += fmt::format("{{ {} }}", fmt::join(element.pairs, ", "));
    }
    if (elements.empty()) tail.clear();
    return editor.replace(array.value_begin, array.end, out + tail + "]");
}

}  // namespace

std::size_t list_size(const TomlEditor& editor, std::string_view key) {
    const TomlPath path{std::string(key)};
    return static_cast<std::size_t>(std::ranges::count_if(editor.items(), [&](const TomlItem& item) {
        return item.path.size() == 2 && is_within(item.path, path) &&
               (item.kind == TomlItem::Kind::ArrayTable || item.is_inside);
    }));
}

Result<> arrange_list(TomlEditor& editor, std::string_view key, std::span<const ListElement> elements) {
    if (const TomlItem* const array = editor.find({std::string(key)})) return arrange_inline(editor, *array, elements);
    if (list_size(editor, key) > 0) return Blocks(editor, key).arrange(elements);
    const std::string& text = editor.text();
    const std::string_view eol = editor.line_end();
    const std::size_t end = text.size();
    std::string blocks = blocks_of(key, elements, eol);
    if (end > 0) blocks.insert(0, text.ends_with('\n') ? std::string(eol) : fmt::format("{0}{0}", eol));
    return editor.replace(end, end, blocks);
}

std::string blocks_of(std::string_view key, std::span<const ListElement> elements, std::string_view line_end) {
    std::string out;
    for (const ListElement& element : elements) {
        if (!out.empty()) out += line_end;
        out += Blocks::block_of(key, element, line_end);
        out += line_end;
    }
    return out;
}

}  // namespace darkroom::edit
