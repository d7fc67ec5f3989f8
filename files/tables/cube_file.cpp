// SPDX-License-Identifier: MIT
#include "tables/cube_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "core/files.hpp"
#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

constexpr std::string_view blanks = " \t\r";
constexpr std::size_t max_comments = 1000;

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string one_line(std::string_view text) {
    std::string out(text);
    std::ranges::replace_if(
        out, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return out;
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> out;
    for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
        // One more than any line may have is told as too many.
        if (out.size() < 8) out.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(blanks, end);
    }
    return out;
}

/// The whole text as one finite number.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if constexpr (std::is_floating_point_v<Number>)
        if (!std::isfinite(number)) return std::nullopt;
    return number;
}

class CubeParser {
  public:
    explicit CubeParser(std::string_view shown) : shown_(shown) {}

    Result<TableFile> parse(std::string_view text) {
        if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
        while (!text.empty()) {
            ++line_;
            const std::size_t end = std::min(text.find('\n'), text.size());
            DARKROOM_TRY(read_line(trimmed(text.substr(0, end))));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return finish();
    }

  private:
    using Words = std::span<const std::string_view>;
    struct Keyword {
        std::string_view name;
        Result<> (CubeParser::*read)(Words values);
        std::size_t line = 0;  ///< that had it; 0: none
    };

    Failure refuse(std::string_view text) const { return user_error(fmt::format("{}:{}: {}", shown_, line_, text)); }

    Result<> read_line(std::string_view line) {
        if (line.empty()) return {};
        if (line.starts_with('#')) {
            const std::string comment(trimmed(one_line(line.substr(1))));
            // As write_cube() has it beside two tables.
            if (rows_ == 0 && out_.title.empty() && comment.starts_with("TITLE \""))
                out_.title = without_quotes(comment.substr(6));
            else if (rows_ == 0 && out_.comments.size() < max_comments)
                out_.comments.push_back(comment);
            return {};
        }
        const std::vector<std::string_view> words = words_of(line);
        // Some programs write small letters, which OpenColorIO takes, too.
        const std::string word = lower(words[0]);
        if (word == "title") return read_title(trimmed(line.substr(5)));
        const bool is_word = (line[0] >= 'A' && line[0] <= 'Z') || word.find('_') != std::string::npos;
        if (!is_word) return read_row(words);
        const auto found = std::ranges::find(keywords_, word, [](const Keyword& known) { return lower(known.name); });
        if (found == keywords_.end()) return refuse_unknown(words[0]);
        if (found->line != 0)
            return refuse(fmt::format("{}: is in line {} already, once is allowed", words[0], found->line));
        if (rows_ > 0) return refuse(fmt::format("{}: stands after entries, allowed is before the first", words[0]));
        found->line = line_;
        return (this->*found->read)(Words(words).subspan(1));
    }

    Failure refuse_unknown(std::string_view word) const {
        std::vector<std::string> names{"TITLE"};
        for (const Keyword& known : keywords_) names.emplace_back(known.name);
        return refuse(fmt::format("unknown keyword '{}'{}", printable(word), alternatives(word, names)));
    }

    // Quotes belong to the format; some programs leave them out.
    static std::string without_quotes(std::string_view text) {
        if (text.size() >= 2 && text.starts_with('"') && text.ends_with('"')) text = text.substr(1, text.size() - 2);
        return std::string(text);
    }

    Result<> read_title(std::string_view text) {
        if (title_line_ != 0) return refuse(fmt::format("TITLE: is in line {} already, once is allowed", title_line_));
        title_line_ = line_;
        out_.title = one_line(without_quotes(text));
        return {};
    }

    Result<std::uint32_t> size_of(Words values, std::uint32_t most) const {
        const std::optional<std::uint32_t> size =
            values.size() == 1 ? number_of<std::uint32_t>(values[0]) : std::nullopt;
        if (size && *size >= min_table_size && *size <= most) return *size;
        return refuse(fmt::format("size {}: allowed is one whole number in [{}, {}]",
                                  printable(fmt::format("{}", fmt::join(values, " "))), min_table_size, most));
    }
    Result<> read_shaper_size(Words values) {
        DARKROOM_TRY_VALUE(out_.table.shaper_size, size_of(values, max_shaper_size));
        return {};
    }
    Result<> read_cube_size(Words values) {
        DARKROOM_TRY_VALUE(out_.table.size, size_of(values, max_cube_size));
        return {};
    }

    template <std::size_t count>
    Result<std::array<float, count>> numbers_of(Words values) const {
        if (values.size() != count)
            return refuse(fmt::format("{} values: expected {} numbers",
                                      values.size() < 8 ? fmt::format("{}", values.size()) : "8 or more", count));
        std::array<float, count> out{};
        for (std::size_t i = 0; i < count; ++i) {
            const std::optional<float> number = number_of<float>(values[i]);
            if (!number)
                return refuse(fmt::format("'{}' is not a finite number of single precision", printable(values[i])));
            out[i] = *number;
        }
        return out;
    }
    Result<> read_domain(Words values, std::array<float, 3>& out) {
        DARKROOM_TRY_VALUE(out, numbers_of<3>(values));
        return {};
    }
    Result<> read_domain_min(Words values) { return read_domain(values, domain_min_); }
    Result<> read_domain_max(Words values) { return read_domain(values, domain_max_); }
    Result<> read_range(Words values, std::array<float, 3>& min, std::array<float, 3>& max) {
        DARKROOM_TRY_VALUE(const auto numbers, numbers_of<2>(values));
        min.fill(numbers[0]);
        max.fill(numbers[1]);
        return {};
    }
    Result<> read_shaper_range(Words values) {
        return read_range(values, out_.table.shaper_min, out_.table.shaper_max);
    }
    Result<> read_cube_range(Words values) { return read_range(values, out_.table.min, out_.table.max); }
    Result<> read_video_range(Words values) {
        return values.empty() ? Result<>() : refuse(fmt::format("{} values: none are expected", values.size()));
    }

    [[nodiscard]] std::uint64_t rows_wanted() const {
        const std::uint64_t edge = out_.table.size;
        return out_.table.shaper_size + edge * edge * edge;
    }

    Result<> read_row(Words values) {
        if (rows_ == 0) DARKROOM_TRY(check_header());
        if (rows_ == rows_wanted())
            return refuse(fmt::format("entry {}: {} asks for {}", rows_ + 1, size_text(), rows_wanted()));
        DARKROOM_TRY_VALUE(const auto numbers, numbers_of<3>(values));
        std::vector<float>& list = rows_ < out_.table.shaper_size ? out_.table.shaper : out_.table.cube;
        list.insert(list.end(), numbers.begin(), numbers.end());
        ++rows_;
        return {};
    }

    [[nodiscard]] std::string size_text() const {
        const ColorTable& table = out_.table;
        std::string out = table.shaper_size > 0 ? fmt::format("LUT_1D_SIZE {}", table.shaper_size) : std::string();
        if (table.size > 0) out += fmt::format("{}LUT_3D_SIZE {}", out.empty() ? "" : " and ", table.size);
        return out;
    }
    [[nodiscard]] bool has(std::string_view name) const {
        return std::ranges::find(keywords_, name, &Keyword::name)->line != 0;
    }

    /// What is wrong with the keywords together, before the first entry is read; and the domain to its table.
    Result<> check_header() {
        ColorTable& table = out_.table;
        if (rows_wanted() == 0)
            return refuse("no LUT_1D_SIZE and no LUT_3D_SIZE before the first entry: one of them is needed");
        // Real files state the range of the other table beside the one that they have. It says nothing of that one, to
        // OpenColorIO neither.
        const ColorTable plain;
        if (table.shaper_size == 0) {
            table.shaper_min = plain.shaper_min;
            table.shaper_max = plain.shaper_max;
        }
        if (table.size == 0) {
            table.min = plain.min;
            table.max = plain.max;
        }
        const bool has_domain = has("DOMAIN_MIN") || has("DOMAIN_MAX");
        for (const auto& [range, size] :
             {std::pair("LUT_1D_INPUT_RANGE", table.shaper_size), std::pair("LUT_3D_INPUT_RANGE", table.size)}) {
            if (has(range) && size > 0 && has_domain)
                return refuse(fmt::format("{} beside DOMAIN_MIN or DOMAIN_MAX: one of them is allowed", range));
        }
        if (has_domain && table.shaper_size > 0 && table.size > 0)
            return refuse(
                "DOMAIN_MIN or DOMAIN_MAX for two tables: LUT_1D_INPUT_RANGE and LUT_3D_INPUT_RANGE say which");
        if (has_domain) {
            (table.size > 0 ? table.min : table.shaper_min) = domain_min_;
            (table.size > 0 ? table.max : table.shaper_max) = domain_max_;
        }
        for (const auto& [min, max] : {std::pair(table.shaper_min, table.shaper_max), std::pair(table.min, table.max)})
            for (std::size_t i = 0; i < 3; ++i)
                if (!(min[i] < max[i]))
                    return refuse(
                        fmt::format("inputs from {} to {}: the first must be below the second", min[i], max[i]));
        return {};
    }

    /// A picture's code values are of the full range, where 0 is black and 1 is white; of video they are 64 and 940 of
    /// 1023. What a table says of those becomes what it does to these.
    void leave_video_range() {
        const auto full = [](float& code) { code = static_cast<float>((double{code} * 1023 - 64) / (940 - 64)); };
        ColorTable& table = out_.table;
        if (has("LUT_IN_VIDEO_RANGE")) {
            out_.comments.emplace_back(
                "Inputs were of video range (LUT_IN_VIDEO_RANGE), and are of the full range now");
            for (auto* const ends : table.shaper_size > 0 ? std::array{&table.shaper_min, &table.shaper_max}
                                                          : std::array{&table.min, &table.max})
                std::ranges::for_each(*ends, full);
        }
        if (has("LUT_OUT_VIDEO_RANGE")) {
            out_.comments.emplace_back(
                "Entries were of video range (LUT_OUT_VIDEO_RANGE), and are of the full range now");
            std::ranges::for_each(table.size > 0 ? table.cube : table.shaper, full);
        }
    }

    Result<TableFile> finish() {
        if (rows_ == 0) DARKROOM_TRY(check_header());
        if (rows_ < rows_wanted())
            return refuse(
                fmt::format("the file ends after {} entries: {} asks for {}", rows_, size_text(), rows_wanted()));
        leave_video_range();
        return std::move(out_);
    }

    std::string_view shown_;
    std::size_t line_ = 0, title_line_ = 0;
    std::uint64_t rows_ = 0;
    std::array<float, 3> domain_min_{0, 0, 0}, domain_max_{1, 1, 1};
    std::array<Keyword, 8> keywords_{{{"LUT_1D_SIZE", &CubeParser::read_shaper_size},
                                      {"LUT_3D_SIZE", &CubeParser::read_cube_size},
                                      {"LUT_1D_INPUT_RANGE", &CubeParser::read_shaper_range},
                                      {"LUT_3D_INPUT_RANGE", &CubeParser::read_cube_range},
                                      {"DOMAIN_MIN", &CubeParser::read_domain_min},
                                      {"DOMAIN_MAX", &CubeParser::read_domain_max},
                                      {"LUT_IN_VIDEO_RANGE", &CubeParser::read_video_range},
                                      {"LUT_OUT_VIDEO_RANGE", &CubeParser::read_video_range}}};
    TableFile out_;
};

void write_entries(fmt::memory_buffer& out, std::span<const float> entries) {
    for (std::size_t i = 0; i + 3 <= entries.size(); i += 3)
        fmt::format_to(std::back_inserter(out), "{} {} {}\n", entries[i], entries[i + 1], entries[i + 2]);
}

}  // namespace

Result<TableFile> parse_cube(std::string_view text, std::string_view shown) { return CubeParser(shown).parse(text); }

Result<TableFile> read_cube(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes, read_file(path, {.max_size = max_cube_file}));
    return parse_cube({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, printable(path.string()));
}

Result<std::string> write_cube(const TableFile& file) {
    const ColorTable& table = file.table;
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    const bool has_both = table.shaper_size > 0 && table.size > 0;
    // OpenColorIO refuses a title in the form with two tables, which Resolve writes without one.
    if (!file.title.empty()) fmt::format_to(to, "{}TITLE \"{}\"\n", has_both ? "# " : "", one_line(file.title));
    for (const std::string& comment : file.comments) fmt::format_to(to, "# {}\n", one_line(comment));
    for (const auto& [name, size, min, max] : {std::tuple("1D", table.shaper_size, table.shaper_min, table.shaper_max),
                                               std::tuple("3D", table.size, table.min, table.max)}) {
        if (size == 0) continue;
        fmt::format_to(to, "LUT_{}_SIZE {}\n", name, size);
        if (!has_both) {
            fmt::format_to(to, "DOMAIN_MIN {}\nDOMAIN_MAX {}\n", fmt::join(min, " "), fmt::join(max, " "));
        } else if (min != std::array{min[0], min[0], min[0]} || max != std::array{max[0], max[0], max[0]}) {
            return user_error(
                fmt::format("inputs of the {} table differ by channel: .cube has one range for all", name));
        } else {
            fmt::format_to(to, "LUT_{}_INPUT_RANGE {} {}\n", name, min[0], max[0]);
        }
    }
    write_entries(out, table.shaper);
    write_entries(out, table.cube);
    return fmt::to_string(out);
}

}  // namespace darkroom
