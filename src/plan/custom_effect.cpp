// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <darkroom/custom_effect.hpp>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "core/files.hpp"
#include "core/param_text.hpp"
#include "plan/glsl_names.hpp"

namespace darkroom {

namespace {

/// All that an EffectInfo refers to. Strings and choices are in deques, because rows hold views of the elements while
/// more are added.
struct Parts {
    std::deque<std::string> strings;
    std::deque<std::vector<std::string_view>> choices;
    std::vector<ParamInfo> rows;
    std::vector<std::uint32_t> defaults;
    std::array<EffectFile, 1> files{};
    EffectInfo info;

    std::string_view keep(std::string_view text) { return strings.emplace_back(text); }
};

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes the first word off the text.
std::string_view next_word(std::string_view& text) {
    text = trimmed(text);
    const std::size_t end = std::min(text.find_first_of(blanks), text.size());
    const std::string_view word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> out;
    for (;;) {
        const std::size_t end = text.find(separator);
        out.push_back(trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) return out;
        text.remove_prefix(end + 1);
    }
}

template <class T, std::size_t Count>
using Names = std::array<std::pair<std::string_view, T>, Count>;

template <class T, std::size_t Count>
std::optional<T> named(const Names<T, Count>& names, std::string_view word) {
    for (const auto& [name, value] : names)
        if (name == word) return value;
    return std::nullopt;
}
template <class T, std::size_t Count>
std::string listed(const Names<T, Count>& names) {
    std::string out;
    for (const auto& [name, value] : names) out += (out.empty() ? "" : ", ") + std::string(name);
    return out;
}

// Curves and resources are made by code: they have no default that fits a line.
constexpr Names<Kind, 8> kinds{{{"float", Kind::Float},
                                {"int", Kind::Int},
                                {"toggle", Kind::Toggle},
                                {"choice", Kind::Choice},
                                {"vec2", Kind::Vec2},
                                {"vec3", Kind::Vec3},
                                {"vec4", Kind::Vec4},
                                {"rgb", Kind::Rgb}}};
constexpr Names<Touch, 2> touches{{{"pointwise", Touch::Pointwise}, {"warp", Touch::Warp}}};
constexpr Names<Domain, 3> domains{
    {{"scene_linear", Domain::SceneLinear}, {"display_linear", Domain::DisplayLinear}, {"encoded", Domain::Encoded}}};
constexpr Names<bool Needs::*, 5> needs{{{"depth", &Needs::depth},
                                         {"normals", &Needs::normals},
                                         {"velocity", &Needs::velocity},
                                         {"shadows", &Needs::shadows},
                                         {"ui", &Needs::ui}}};
constexpr Names<Unit, 6> units{{{unit::pixels.symbol, unit::pixels},
                                {unit::nits.symbol, unit::nits},
                                {unit::metres.symbol, unit::metres},
                                {unit::per_metre.symbol, unit::per_metre},
                                {unit::degrees.symbol, unit::degrees},
                                {unit::seconds.symbol, unit::seconds}}};

/// gaussian_blur -> GaussianBlur
std::string pascal_name(std::string_view snake) {
    std::string out;
    bool is_start = true;
    for (const char c : snake) {
        if (c != '_') out += is_start && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        is_start = c == '_';
    }
    return out;
}

std::uint32_t words_of(Kind kind) {
    switch (kind) {
        case Kind::Vec2:
            return 2;
        case Kind::Vec3:
        case Kind::Rgb:
            return 3;
        case Kind::Vec4:
            return 4;
        default:
            return 1;
    }
}

class Parser {
  public:
    Parser(Parts& parts, std::string_view shown_name) : parts_(parts), shown_name_(shown_name) {}

    Result<> run(std::string_view text) {
        if (text.find('\0') != std::string_view::npos) return error("a zero byte; the file is no text");
        const std::string_view kept = parts_.keep(text);
        for (std::string_view rest = kept; !rest.empty();) {
            ++line_;
            const std::size_t end = rest.find('\n');
            const std::string_view content = trimmed(rest.substr(0, end));
            rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
            if (content.empty()) continue;
            if (!content.starts_with("//")) break;
            std::string_view comment = trimmed(content.substr(2));
            if (!comment.starts_with('@')) continue;
            const std::string_view word = next_word(comment);
            if (auto ok = statement(word, comment); !ok) return ok;
        }
        line_ = 1;
        if (parts_.info.name.empty()) return error("no line `// @effect NAME: SENTENCE.` before the code");
        const std::string parameters = pascal_name(parts_.info.name);
        if (!plan::calls_name(kept, parts_.info.name))
            return error(fmt::format("no function {}: expected `vec4 {}({}Pixel pixel, {} parameters)`",
                                     parts_.info.name, parts_.info.name,
                                     parts_.info.touch == Touch::Warp ? "" : "vec4 color, ", parameters));
        parts_.files[0] = {parts_.keep(std::string(parts_.info.name) + ".glsl"), kept};
        parts_.info.files = parts_.files;
        parts_.info.parameters = {parts_.keep(parameters), parts_.rows, parts_.defaults};
        return {};
    }

  private:
    [[nodiscard]] Failure error(std::string_view text) const {
        return user_error(fmt::format("{}:{}: {}", shown_name_, line_, text));
    }

    Result<> statement(std::string_view word, std::string_view rest) {
        if (word == "@effect") return effect(rest);
        if (word == "@param") return parameter(rest);
        if (word == "@touch") {
            const auto touch = named(touches, rest);
            if (!touch) return error(fmt::format("@touch {}: allowed is {}", printable(rest), listed(touches)));
            parts_.info.touch = *touch;
            return {};
        }
        if (word == "@accepts") {
            parts_.info.accepts = {};
            do {
                const std::string_view name = next_word(rest);
                const auto domain = named(domains, name);
                if (!domain) return error(fmt::format("@accepts {}: allowed is {}", printable(name), listed(domains)));
                parts_.info.accepts = parts_.info.accepts | Domains::only(*domain);
            } while (!rest.empty());
            return {};
        }
        if (word == "@needs") {
            do {
                const std::string_view name = next_word(rest);
                const auto need = named(needs, name);
                if (!need) return error(fmt::format("@needs {}: allowed is {}", printable(name), listed(needs)));
                parts_.info.needs.** need = true;
            } while (!rest.empty());
            return {};
        }
        return error(fmt::format("{}: allowed is @effect, @touch, @accepts, @needs, @param", printable(word)));
    }

    /// Splits "HEAD: Sentence." and keeps the sentence.
    Result<std::pair<std::string_view, std::string_view>> with_sentence(std::string_view text) const {
        const std::size_t colon = text.find(':');
        const std::string_view sentence =
            colon == std::string_view::npos ? std::string_view{} : trimmed(text.substr(colon + 1));
        if (sentence.empty() || sentence.back() != '.')
            return error(
                fmt::format("{}: expected a colon and a sentence that ends with a full stop", printable(text)));
        return std::pair{trimmed(text.substr(0, colon)), sentence};
    }

    Result<> checked_name(std::string_view name) const {
        if (!plan::is_snake_name(name))
            return error(
                fmt::format("{}: a name is made of lower-case letters, digits and single underscores, and begins with "
                            "a letter",
                            printable(name)));
        if (plan::is_glsl_keyword(name)) return error(fmt::format("{}: a keyword of GLSL", name));
        return {};
    }

    Result<> effect(std::string_view rest) {
        if (!parts_.info.name.empty()) return error("a second @effect; a file holds one");
        auto halves = with_sentence(rest);
        if (!halves) return failure(std::move(halves));
        if (auto ok = checked_name(halves->first); !ok) return ok;
        if (plan::is_function_name(halves->first))
            return error(fmt::format("{}: a function of GLSL or of the kernels", halves->first));
        parts_.info.name = parts_.keep(halves->first);
        parts_.info.doc = parts_.keep(halves->second);
        return {};
    }

    Result<> parameter(std::string_view rest) {
        auto halves = with_sentence(rest);
        if (!halves) return failure(std::move(halves));
        const std::size_t equals = halves->first.find('=');
        std::string_view head = halves->first.substr(0, equals);
        const std::string_view kind_name = next_word(head), name = next_word(head);
        const auto kind = named(kinds, kind_name);
        if (!kind) return error(fmt::format("@param {}: allowed is {}", printable(kind_name), listed(kinds)));
        if (auto ok = checked_name(name); !ok) return ok;
        if (equals == std::string_view::npos || !head.empty())
            return error(fmt::format("{}: expected `@param {} {} = DEFAULT`", name, kind_name, name));
        // They belong to the stack entry, and a look could not tell them apart.
        static constexpr std::string_view entry_keys[] = {"effect", "enabled", "name",    "input", "source",
                                                          "second", "output",  "opacity", "blend", "mask"};
        if (std::ranges::find(entry_keys, name) != std::end(entry_keys))
            return error(fmt::format("{}: a key of every stack entry", name));
        if (std::ranges::find(parts_.rows, name, &ParamInfo::name) != parts_.rows.end())
            return error(fmt::format("{}: described twice", name));

        ParamInfo row{.name = parts_.keep(name),
                      .doc = parts_.keep(halves->second),
                      .kind = *kind,
                      .word = static_cast<std::uint32_t>(parts_.defaults.size()),
                      .words = words_of(*kind)};
        std::string_view value = trimmed(halves->first.substr(equals + 1));
        if (*kind == Kind::Choice) {
            auto first = choices(row, value);
            if (!first) return failure(std::move(first));
            value = *first;
        } else if (*kind != Kind::Toggle) {
            auto number = interval_and_more(row, value);
            if (!number) return failure(std::move(number));
            value = *number;
        }
        if (value.empty())
            return error(fmt::format("{}: no default: expected `@param {} {} = DEFAULT`", name, kind_name, name));
        return add(row, value);
    }

    /// Reads "luma | red | green"; the default is the first.
    Result<std::string_view> choices(ParamInfo& row, std::string_view text) {
        std::vector<std::string_view>& names = parts_.choices.emplace_back();
        for (const std::string_view choice : split(text, '|')) {
            if (!plan::is_snake_name(choice))
                return error(fmt::format("{} = {}: a choice is lower-case letters, digits and single underscores",
                                         row.name, printable(choice)));
            if (std::ranges::find(names, choice) != names.end())
                return error(fmt::format("{} = {}: named twice", row.name, choice));
            names.push_back(parts_.keep(choice));
        }
        if (names.size() < 2)
            return error(fmt::format("{}: a choice has two names or more, as `luma | red`", row.name));
        row.choices = names;
        return names.front();
    }

    /// Reads "DEFAULT in [a, b] px log amount"; returns the default.
    Result<std::string_view> interval_and_more(ParamInfo& row, std::string_view text) const {
        const std::size_t in = text.find(" in "), open = text.find('['), close = text.find(']');
        if (in == std::string_view::npos || close == std::string_view::npos || open > close || open < in ||
            !trimmed(text.substr(in + 4, open - in - 4)).empty())
            return error(fmt::format("{}: no interval: expected `= DEFAULT in [LOWEST, HIGHEST]`", row.name));
        const std::vector<std::string_view> bounds = split(text.substr(open + 1, close - open - 1), ',');
        const auto low = parse_number(bounds.front()), high = parse_number(bounds.back());
        const std::string shown(text.substr(open, close + 1 - open));
        if (bounds.size() != 2 || !low || !high)
            return error(fmt::format("{} in {}: expected two numbers", row.name, printable(shown)));
        if (!(*low < *high)) return error(fmt::format("{} in {}: the interval is empty", row.name, printable(shown)));
        row.range = {*low, *high};
        for (std::string_view rest = trimmed(text.substr(close + 1)); !rest.empty();) {
            const std::string_view word = next_word(rest);
            if (word == "log") {
                if (*low <= 0) return error(fmt::format("{} in {}: with log the lowest is above 0", row.name, shown));
                row.range.scale = Scale::Log;
            } else if (word == "amount") {
                row.is_amount = true;
            } else if (const auto found = named(units, word)) {
                row.unit = *found;
            } else {
                return error(fmt::format("{}: {}: allowed is a unit ({}), log, amount", row.name, printable(word),
                                         listed(units)));
            }
        }
        return trimmed(text.substr(0, in));
    }

    Result<> add(const ParamInfo& row, std::string_view text) {
        std::string dense(text);
        std::erase(dense, ' ');
        const auto value = parse_text(row, dense);
        if (!value) return error(fmt::format("{} = {}: {}", row.name, printable(text), value.error().text));
        parts_.defaults.resize(parts_.defaults.size() + row.words);
        if (const auto ok = assign(row, parts_.defaults, *value); !ok) return error(ok.error().text);
        parts_.rows.push_back(row);
        return {};
    }

    Parts& parts_;
    std::string_view shown_name_;
    std::size_t line_ = 0;
};

}  // namespace

struct CustomEffect::State : Parts {};

CustomEffect::CustomEffect(std::shared_ptr<const State> state) : state_(std::move(state)) {}
CustomEffect::CustomEffect(CustomEffect&&) noexcept = default;
CustomEffect& CustomEffect::operator=(CustomEffect&&) noexcept = default;
CustomEffect::~CustomEffect() = default;

const EffectInfo& CustomEffect::info() const { return state_->info; }

Result<CustomEffect> CustomEffect::parse(std::string_view text, std::string_view shown_name) {
    auto state = std::make_shared<State>();
    state->info.owner = state;
    if (auto ok = Parser(*state, shown_name).run(text); !ok) return failure(std::move(ok));
    return CustomEffect(std::move(state));
}

Result<CustomEffect> CustomEffect::load(const std::filesystem::path& file) {
    auto bytes = read_file(file);
    if (!bytes) return failure(std::move(bytes));
    return parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string());
}

}  // namespace darkroom
