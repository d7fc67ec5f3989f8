// SPDX-License-Identifier: MIT
#include "core/text/param_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/text/quantity.hpp"

namespace darkroom {

namespace {

using Why = ParamProblem::Why;

template <class... Lambdas>
struct Overloaded : Lambdas... {
    using Lambdas::operator()...;
};
template <class... Lambdas>
Overloaded(Lambdas...) -> Overloaded<Lambdas...>;

std::string join(std::span<const std::string_view> names) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) out += i + 1 == names.size() ? " or " : ", ";
        out += names[i];
    }
    return out;
}

std::string show(const ParamValue& value) {
    return std::visit(
        Overloaded{[](bool v) -> std::string { return v ? "true" : "false"; },
                   [](std::int64_t v) { return fmt::format("{}", v); }, [](double v) { return fmt::format("{}", v); },
                   [](const std::string& v) { return fmt::format("\"{}\"", printable(v)); },
                   [](const std::vector<double>& v) {
                       if (v.size() > 8) return fmt::format("an array of {} numbers", v.size());
                       return fmt::format("[{}]", fmt::join(v, ", "));
                   },
                   [](const CurvePoints& v) { return fmt::format("a curve of {} points", v.size()); }},
        value);
}

// Compared as the float that is stored, so that a bound such as 0.1, which no float equals, is inside.
bool is_allowed(double value, const Range& range) {
    if (!std::isfinite(value) || std::abs(value) > std::numeric_limits<float>::max()) return false;
    const auto stored = static_cast<float>(value);
    return stored >= static_cast<float>(range.min) && stored <= static_cast<float>(range.max);
}

std::optional<double> as_number(const ParamValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    return std::nullopt;
}

// The kinds that are a fixed number of floats in a row.
bool is_vector(Kind kind) {
    return kind == Kind::Vec2 || kind == Kind::Vec3 || kind == Kind::Vec4 || kind == Kind::Rgb;
}

constexpr double lines_of_known_height = 1080;

// "2.5%" of the picture's height, in pixels of one of 1080 lines.
std::optional<double> parse_share(std::string_view text) {
    if (!text.ends_with('%')) return std::nullopt;
    text.remove_suffix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    const std::optional<double> number = parse_number(text);
    return number ? std::optional(*number * lines_of_known_height / 100) : std::nullopt;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> out;
    for (;;) {
        const std::size_t end = text.find(separator);
        std::string_view part = text.substr(0, end);
        while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
        while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
        out.push_back(part);
        if (end == std::string_view::npos) return out;
        text.remove_prefix(end + 1);
    }
}

// A size whose text has a share in it: the numbers; whole numbers take the nearest. Nothing: it is none.
std::optional<ParamValue> sizes_of(const ParamInfo& info, const ParamValue& value) {
    const auto* const text = std::get_if<std::string>(&value);
    if (text == nullptr || info.reach_word == ~0u || text->find('%') == std::string::npos) return std::nullopt;
    std::vector<double> numbers;
    for (const std::string_view part : split(*text, ',')) {
        std::optional<double> number = parse_share(part);
        if (!number) number = parse_quantity(part, info.unit.symbol);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    if (is_vector(info.kind)) return ParamValue(std::move(numbers));
    if (numbers.size() != 1) return std::nullopt;
    return ParamValue(info.kind == Kind::Int ? std::round(numbers[0]) : numbers[0]);
}

// Checks one value and turns it into words; the caller knows where they go.
class Assignment {
  public:
    Assignment(const ParamInfo& info, const ParamValue& value, std::string_view shown)
        : info_(info), value_(value), shown_(shown.empty() ? info.name : shown) {}

    std::optional<ParamProblem> run(std::vector<std::uint32_t>& out) {
        switch (info_.kind) {
            case Kind::Float:
                return put_float(out);
            case Kind::Int:
                return put_whole(out, info_.range.min, info_.range.max);
            case Kind::Resource:
                return put_whole(out, 0, std::numeric_limits<std::uint32_t>::max());
            case Kind::Toggle:
                return put_toggle(out);
            case Kind::Choice:
                return put_choice(out);
            case Kind::Curve:
                return put_curve(out);
            default:
                return put_vector(out);
        }
    }

  private:
    ParamProblem wrong_kind() const {
        return {Why::WrongKind, fmt::format("{} = {}: expected {}, {}", shown_, show(value_), expected_kind(info_.kind),
                                            "allowed is " + interval(info_))};
    }
    ParamProblem out_of_range() const {
        return {Why::OutOfRange, fmt::format("{} = {}: allowed is {}", shown_, show(value_), interval(info_))};
    }

    std::optional<ParamProblem> put_float(std::vector<std::uint32_t>& out) const {
        const std::optional<double> number = as_number(value_);
        if (!number) return wrong_kind();
        if (!is_allowed(*number, info_.range)) return out_of_range();
        out.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(*number)));
        return std::nullopt;
    }

    std::optional<ParamProblem> put_whole(std::vector<std::uint32_t>& out, double low, double high) const {
        const std::optional<double> number = as_number(value_);
        if (!number) return wrong_kind();
        if (std::isfinite(*number) && std::trunc(*number) != *number) return wrong_kind();
        if (!(*number >= low && *number <= high)) return out_of_range();
        out.push_back(static_cast<std::uint32_t>(static_cast<std::int64_t>(*number)));
        return std::nullopt;
    }

    std::optional<ParamProblem> put_toggle(std::vector<std::uint32_t>& out) const {
        const auto* on = std::get_if<bool>(&value_);
        if (on == nullptr) return wrong_kind();
        out.push_back(*on ? 1u : 0u);
        return std::nullopt;
    }

    std::optional<ParamProblem> put_choice(std::vector<std::uint32_t>& out) const {
        const auto* name = std::get_if<std::string>(&value_);
        if (name == nullptr) return wrong_kind();
        const auto found = std::find(info_.choices.begin(), info_.choices.end(), *name);
        if (found == info_.choices.end()) {
            const std::vector<std::string> names(info_.choices.begin(), info_.choices.end());
            return ParamProblem{Why::OutOfRange,
                                fmt::format("{} = {}{}", shown_, show(value_), alternatives(*name, names))};
        }
        out.push_back(static_cast<std::uint32_t>(found - info_.choices.begin()));
        return std::nullopt;
    }

    std::optional<ParamProblem> put_vector(std::vector<std::uint32_t>& out) const {
        const auto* numbers = std::get_if<std::vector<double>>(&value_);
        if (numbers == nullptr || numbers->size() != info_.words) return wrong_kind();
        for (const double number : *numbers) {
            if (!is_allowed(number, info_.range)) return out_of_range();
            out.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(number)));
        }
        return std::nullopt;
    }

    std::optional<ParamProblem> put_curve(std::vector<std::uint32_t>& out) const {
        const auto* points = std::get_if<CurvePoints>(&value_);
        const auto* flat = std::get_if<std::vector<double>>(&value_);
        const bool is_empty = flat != nullptr && flat->empty();  // [] in a file has no type
        if (points == nullptr && !is_empty) return wrong_kind();
        Curve curve;
        if (points != nullptr) {
            if (points->size() > Curve::capacity) return out_of_range();
            for (const auto& [x, y] : *points) {
                const bool is_usable = std::isfinite(x) && std::abs(x) <= std::numeric_limits<float>::max();
                if (!is_usable || !is_allowed(y, info_.range)) return out_of_range();
                const auto position = static_cast<float>(x);
                if (curve.count > 0 && !(position > curve.x[curve.count - 1])) return out_of_range();
                curve.x[curve.count] = position;
                curve.y[curve.count++] = static_cast<float>(y);
            }
        }
        const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Curve) / 4>>(curve);
        out.assign(words.begin(), words.end());
        return std::nullopt;
    }

    const ParamInfo& info_;
    const ParamValue& value_;
    std::string_view shown_;
};

// A float as TOML: what fmt prints is the shortest text with the same bits, but "1" would be a TOML integer.
std::string toml_float(float value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

Curve curve_of(std::span<const std::uint32_t> words) {
    std::array<std::uint32_t, sizeof(Curve) / 4> copy{};
    std::copy_n(words.begin(), copy.size(), copy.begin());
    return std::bit_cast<Curve>(copy);
}

// Words back to the value they hold; nothing for words that are no value (a choice or curve beyond its end).
std::optional<ParamValue> value_of(const ParamInfo& info, std::span<const std::uint32_t> words) {
    switch (info.kind) {
        case Kind::Float:
            return static_cast<double>(std::bit_cast<float>(words[0]));
        case Kind::Int:
            return static_cast<std::int64_t>(static_cast<std::int32_t>(words[0]));
        case Kind::Resource:
            return static_cast<std::int64_t>(words[0]);
        case Kind::Toggle:
            return words[0] != 0;
        case Kind::Choice:
            if (words[0] >= info.choices.size()) return std::nullopt;
            return std::string(info.choices[words[0]]);
        case Kind::Curve: {
            const Curve curve = curve_of(words);
            if (curve.count > Curve::capacity) return std::nullopt;
            CurvePoints points;
            for (std::uint32_t i = 0; i < curve.count; ++i) points.push_back({curve.x[i], curve.y[i]});
            return points;
        }
        default:
            break;
    }
    std::vector<double> numbers;
    for (const std::uint32_t word : words) numbers.push_back(std::bit_cast<float>(word));
    return numbers;
}

bool takes_stops(const ParamInfo& info) { return info.unit.symbol == unit::multiplier.symbol; }

// What else may stand behind a number.
std::string typed_with(const ParamInfo& info) {
    if (info.reach_word != ~0u) return ", also in % of the height";
    const std::string suffixes = other_suffixes(info.unit.symbol);
    return suffixes.empty() ? "" : fmt::format(", also in {}", suffixes);
}

}  // namespace

std::optional<ParamProblem> try_assign(const ParamInfo& info, std::span<std::uint32_t> words, const ParamValue& value,
                                       std::string_view shown) {
    std::vector<std::uint32_t> out;
    const std::optional<ParamValue> sizes = sizes_of(info, value);
    if (std::optional<ParamProblem> problem = Assignment(info, sizes ? *sizes : value, shown).run(out)) return problem;
    std::copy(out.begin(), out.end(), words.begin() + info.word);
    if (sizes && info.reach_word < words.size()) words[info.reach_word] = static_cast<std::uint32_t>(Reach::Height);
    return std::nullopt;
}

Result<> assign(const ParamInfo& info, std::span<std::uint32_t> words, const ParamValue& value,
                std::string_view shown) {
    if (std::optional<ParamProblem> problem = try_assign(info, words, value, shown)) return user_error(problem->text);
    return {};
}

Result<> check_words(const ParamInfo& info, std::span<const std::uint32_t> words, std::string_view shown) {
    const std::string_view name = shown.empty() ? info.name : shown;
    if (words.size() != info.words)
        return user_error(
            fmt::format("{}: given {} words, a {} has {}", name, words.size(), expected_kind(info.kind), info.words));
    const std::optional<ParamValue> value = value_of(info, words);
    if (!value) return user_error(fmt::format("{} = {}: allowed is {}", name, words[0], interval(info)));
    std::vector<std::uint32_t> unused;
    if (std::optional<ParamProblem> problem = Assignment(info, *value, name).run(unused))
        return user_error(problem->text);
    return {};
}

std::optional<bool> parse_toggle(std::string_view text) {
    for (const std::string_view yes : {"true", "on", "yes", "1"})
        if (text == yes) return true;
    for (const std::string_view no : {"false", "off", "no", "0"})
        if (text == no) return false;
    return std::nullopt;
}

std::optional<double> parse_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    if (text.starts_with('+')) return std::nullopt;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
    return number;
}

Result<ParamValue> parse_text(const ParamInfo& info, std::string_view text) {
    const auto refuse = [&] {
        return user_error(fmt::format("'{}' is not {}, allowed is {}{}", printable(text), expected_kind(info.kind),
                                      interval(info), typed_with(info)));
    };
    if (info.kind == Kind::Choice) return ParamValue(std::string(text));
    if (info.reach_word != ~0u && text.find('%') != std::string_view::npos) {
        ParamValue value = std::string(text);
        return sizes_of(info, value) ? Result<ParamValue>(std::move(value)) : refuse();
    }
    if (info.kind == Kind::Toggle) {
        const std::optional<bool> on = parse_toggle(text);
        if (!on) return refuse();
        return ParamValue(*on);
    }
    if (info.kind == Kind::Curve) {
        CurvePoints points;
        if (text.empty()) return ParamValue(points);
        for (const std::string_view point : split(text, ',')) {
            const std::vector<std::string_view> parts = split(point, ':');
            if (parts.size() != 2) return refuse();
            const std::optional<double> x = parse_number(parts[0]), y = parse_number(parts[1]);
            if (!x || !y) return refuse();
            points.push_back({*x, *y});
        }
        return ParamValue(std::move(points));
    }
    if (is_vector(info.kind)) {
        std::vector<double> numbers;
        for (const std::string_view part : split(text, ',')) {
            const std::optional<double> number = parse_quantity(part, info.unit.symbol);
            if (!number) return refuse();
            numbers.push_back(*number);
        }
        if (numbers.size() != info.words) return refuse();
        return ParamValue(std::move(numbers));
    }
    const std::optional<double> number = parse_quantity(text, info.unit.symbol);
    if (!number) return refuse();
    return ParamValue(*number);
}

std::string format(const ParamInfo& info, std::span<const std::uint32_t> words) {
    const std::span<const std::uint32_t> own = words.subspan(info.word, info.words);
    switch (info.kind) {
        case Kind::Float:
            return toml_float(std::bit_cast<float>(own[0]));
        case Kind::Int:
            return fmt::format("{}", static_cast<std::int32_t>(own[0]));
        case Kind::Resource:
            // Files have names, which only their look knows.
            return own[0] == 0 ? "\"\"" : fmt::format("{}", own[0]);
        case Kind::Toggle:
            return own[0] != 0 ? "true" : "false";
        case Kind::Choice:
            return fmt::format("\"{}\"", own[0] < info.choices.size() ? info.choices[own[0]] : "");
        default:
            break;
    }
    std::vector<std::string> parts;
    if (info.kind == Kind::Curve) {
        const Curve curve = curve_of(own);
        for (std::size_t i = 0; i < std::min<std::size_t>(curve.count, Curve::capacity); ++i)
            parts.push_back(fmt::format("[{}, {}]", toml_float(curve.x[i]), toml_float(curve.y[i])));
    } else {
        for (const std::uint32_t word : own) parts.push_back(toml_float(std::bit_cast<float>(word)));
    }
    return fmt::format("[{}]", fmt::join(parts, ", "));
}

std::string format_for_file(const ParamInfo& info, std::span<const std::uint32_t> words) {
    if (info.reach_word >= words.size() || words[info.reach_word] != static_cast<std::uint32_t>(Reach::Height))
        return format(info, words);
    std::vector<std::string> shares;
    for (const std::uint32_t word : words.subspan(info.word, info.words)) {
        const bool is_whole = info.kind == Kind::Int;
        double size = std::bit_cast<float>(word);
        if (is_whole) size = static_cast<std::int32_t>(word);
        const auto reads_back = [&](const std::string& text) {
            const double read = parse_share(text).value_or(-1);
            return (is_whole ? std::round(read) : double{static_cast<float>(read)}) == size;
        };
        std::string share;
        for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10 && !reads_back(share); ++digits)
            share = fmt::format("{:.{}g}%", size / lines_of_known_height * 100, digits);
        shares.push_back(std::move(share));
    }
    return fmt::format("\"{}\"", fmt::join(shares, ", "));
}

std::string interval(const ParamInfo& info) {
    if (info.kind == Kind::Choice) return join(info.choices);
    if (info.kind == Kind::Toggle) return "true or false";
    if (info.kind == Kind::Resource) return "the name of a file, empty for none";
    std::string out = fmt::format("[{}, {}]", info.range.min, info.range.max);
    if (!info.unit.symbol.empty()) out += fmt::format(" {}", info.unit.symbol);
    if (info.kind == Kind::Curve)
        return fmt::format("up to {} points [x, y], x ascending, y in {}", Curve::capacity, out);
    return out;
}

std::string full_doc(const ParamInfo& info) {
    return std::string(info.doc) + (takes_stops(info) ? " Also in stops: 1ev is 2." : "") +
           (info.reach_word != ~0u ? " Also in % of the picture's height." : "") +
           (info.is_at_compile ? " A change takes full effect with the next compile." : "");
}

std::string_view expected_kind(Kind kind) {
    switch (kind) {
        case Kind::Float:
            return "a number";
        case Kind::Int:
            return "a whole number";
        case Kind::Toggle:
            return "a boolean";
        case Kind::Choice:
            return "a name";
        case Kind::Vec2:
            return "2 numbers";
        case Kind::Vec3:
            return "3 numbers";
        case Kind::Vec4:
            return "4 numbers";
        case Kind::Rgb:
            return "3 numbers (red, green, blue)";
        case Kind::Curve:
            return "a curve";
        case Kind::Resource:
            return "the name of a file";
    }
    return "a value";
}

std::string documentation(const ParamTable& table, std::string_view effect) {
    std::string out = "| Key | Default | Allowed | What it does |\n|---|---|---|---|\n";
    for (const ParamInfo& row : table.rows) {
        std::string what = full_doc(row);
        if (row.is_amount)
            what += fmt::format(" In a flat table or as a flag, a value {} 0 turns the effect on and 0 turns it off.",
                                row.range.min < 0 ? "other than" : "above");
        if (!row.formerly.empty()) what += fmt::format(" Formerly `{}`.", flat_key(effect, row.formerly));
        if (!row.also.empty()) what += fmt::format(" In consoles also `{}`.", row.also);
        out += fmt::format("| `{}` | `{}` | {} | {} |\n", flat_key(effect, row.name), format(row, table.defaults),
                           interval(row), what);
    }
    const std::string prefix = fmt::format("{}_", effect);
    if (std::ranges::any_of(table.rows,
                            [&](const ParamInfo& row) { return flat_key(effect, row.name).starts_with(prefix); }))
        out += fmt::format("\nIn an entry of a `[[stack]]` the keys stand without `{}`.\n", prefix);
    return out;
}

}  // namespace darkroom
