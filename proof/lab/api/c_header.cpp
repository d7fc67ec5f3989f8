// SPDX-License-Identifier: MIT
#include "c_header.hpp"

#include <fmt/format.h>
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <darkroom/result.hpp>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/text/param_text.hpp"

namespace app {

using darkroom::Result;

namespace {

// The words of darkroom.h, one after another. What stands between #if and #endif is for compilers alone and is passed
// over, but for the header's own guard.

struct CToken {
    enum class Kind {
        Name,
        Number,
        Sign,       ///< one of {}()[];,*=
        Define,     ///< what a #define calls; its number is next
        Doc,        ///< "/// text"
        DocBehind,  ///< "///< text"
        End
    };
    Kind kind = Kind::End;
    std::string text;
    std::size_t line = 0;  ///< from 1
};

constexpr std::size_t max_size = std::size_t{1} << 20;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Takes what begins `text` and is all `is_part`.
template <class IsPart>
std::string_view take(std::string_view& text, const IsPart& is_part) {
    const auto end = std::ranges::find_if_not(text, is_part);
    const std::string_view taken = text.substr(0, static_cast<std::size_t>(end - text.begin()));
    text.remove_prefix(taken.size());
    return taken;
}

class Lines {
  public:
    [[nodiscard]] std::vector<CToken> tokens() && { return std::move(tokens_); }
    /// What is wrong with the line.
    [[nodiscard]] std::optional<std::string> add(std::string_view line) {
        ++line_;
        line = trimmed(line);
        if (line.starts_with('#')) return add_directive(trimmed(line.substr(1)));
        if (depth_ > 0) return {};
        if (line.starts_with("/*"))
            return line.find("*/") == line.size() - 2 ? std::nullopt
                                                      : std::optional("a comment of this kind takes one line");
        return add_words(line);
    }
    [[nodiscard]] std::optional<std::string> end() {
        if (depth_ > 0 || is_guard_open_) return "a #if has no #endif";
        add(CToken::Kind::End, "");
        return {};
    }

  private:
    void add(CToken::Kind kind, std::string_view text) { tokens_.push_back({kind, std::string(text), line_}); }

    [[nodiscard]] std::optional<std::string> add_directive(std::string_view line) {
        const std::string_view name = take(line, is_letter);
        line = trimmed(line);
        if (name.starts_with("if")) {
            if (depth_ == 0 && guard_.empty() && name == "ifndef") {
                guard_ = line;
                is_guard_open_ = true;
            } else {
                ++depth_;
            }
            return {};
        }
        if (name == "endif") {
            if (depth_ == 0 && !is_guard_open_) return "a #endif has no #if";
            if (depth_ > 0)
                --depth_;
            else
                is_guard_open_ = false;
            return {};
        }
        if (depth_ > 0 || name == "include") return {};
        if (name != "define") return "expected #if, #endif, #include or #define";
        if (line == guard_) return {};
        return add_define(line);
    }
    [[nodiscard]] std::optional<std::string> add_define(std::string_view line) {
        const auto is_part = [](char c) { return is_letter(c) || is_digit(c); };
        const std::string_view name = take(line, is_part);
        line = trimmed(line);
        constexpr std::string_view wide = "UINT64_C(";
        const bool is_wide = line.starts_with(wide) && line.ends_with(')');
        if (is_wide) line = line.substr(wide.size(), line.size() - wide.size() - 1);
        if (name.empty() || line.empty() || !std::ranges::all_of(line, is_digit))
            return "expected #define NAME NUMBER, the number as digits or UINT64_C(digits)";
        add(CToken::Kind::Define, name);
        if (is_wide) add(CToken::Kind::Name, wide.substr(0, wide.size() - 1));
        add(CToken::Kind::Number, line);
        return {};
    }
    [[nodiscard]] std::optional<std::string> add_words(std::string_view line) {
        while (!line.empty()) {
            if (line.starts_with("//")) {
                if (line.starts_with("///<"))
                    add(CToken::Kind::DocBehind, trimmed(line.substr(4)));
                else if (line.starts_with("///"))
                    add(CToken::Kind::Doc, trimmed(line.substr(3)));
                return {};
            }
            if (is_letter(line.front())) {
                add(CToken::Kind::Name, take(line, [](char c) { return is_letter(c) || is_digit(c); }));
            } else if (is_digit(line.front())) {
                add(CToken::Kind::Number, take(line, is_digit));
            } else if (std::string_view("{}()[];,*=").find(line.front()) != std::string_view::npos) {
                add(CToken::Kind::Sign, line.substr(0, 1));
                line.remove_prefix(1);
            } else {
                return fmt::format("expected a name, a number or one of {{}}()[];,*= and not '{}'",
                                   darkroom::printable(line.substr(0, 1)));
            }
            line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        }
        return {};
    }

    std::vector<CToken> tokens_;
    std::size_t line_ = 0;
    std::size_t depth_ = 0;  // of #if that are passed over
    std::string guard_;
    bool is_guard_open_ = false;
};

/// "shown:line: what stands there: fault".
darkroom::Failure c_error(std::string_view text, std::string_view shown, std::size_t line, std::string_view fault) {
    for (std::size_t i = 1; i < line; ++i) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    const std::string_view there = trimmed(text.substr(0, text.find('\n')));
    return darkroom::user_error(
        fmt::format("{}:{}: '{}': {}", darkroom::printable(shown), line, darkroom::printable(there), fault));
}

/// The last one is End. Errors as those of parse_c_header.
Result<std::vector<CToken>> c_tokens(std::string_view text, std::string_view shown) {
    if (text.size() > max_size)
        return darkroom::user_error(
            fmt::format("{}: {} bytes, allowed are at most {}", darkroom::printable(shown), text.size(), max_size));
    Lines lines;
    std::size_t number = 0;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        ++number;
        if (const auto fault = lines.add(line)) return c_error(text, shown, number, *fault);
    }
    if (const auto fault = lines.end()) return c_error(text, shown, number, *fault);
    return std::move(lines).tokens();
}

using Word = CToken::Kind;

constexpr std::array c_types{"void", "char", "float", "double", "int32_t", "uint32_t", "uint64_t", "size_t"};
constexpr std::size_t max_stars = 3, max_items = 1000, max_length = 65536;

/// Each function that takes a piece of the text says whether it was there; what was wrong first stays.
class CParser {
  public:
    explicit CParser(std::vector<CToken> tokens) : tokens_(std::move(tokens)) {
        types_.insert(c_types.begin(), c_types.end());
        for (const VulkanType& type : vulkan_types()) types_.emplace(type.name);
    }
    [[nodiscard]] bool parse() {
        while (peek().kind != Word::End)
            if (!declaration()) return false;
        return doc_.empty() || refuse("expected a declaration behind its documentation");
    }
    [[nodiscard]] CHeader header() && { return std::move(header_); }
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] const std::string& fault() const { return fault_; }

  private:
    [[nodiscard]] const CToken& peek(std::size_t ahead = 0) const {
        return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
    [[nodiscard]] bool refuse(std::string fault) {
        if (fault_.empty()) {
            fault_ = std::move(fault);
            line_ = peek().line;
        }
        return false;
    }
    [[nodiscard]] bool refuse_word(std::string_view expected) {
        const CToken& token = peek();
        return refuse(token.kind == Word::End ? fmt::format("expected {} and not the end", expected)
                                              : fmt::format("expected {} at '{}'", expected, printable(token)));
    }
    static std::string printable(const CToken& token) { return darkroom::printable(token.text); }

    [[nodiscard]] bool is(std::string_view text) const {
        return (peek().kind == Word::Name || peek().kind == Word::Sign) && peek().text == text;
    }
    [[nodiscard]] bool skip(std::string_view text) {
        if (!is(text)) return false;
        ++at_;
        return true;
    }
    [[nodiscard]] bool expect(std::string_view text) { return skip(text) || refuse_word(fmt::format("'{}'", text)); }
    [[nodiscard]] bool name(std::string& to, std::string_view begin = "") {
        if (peek().kind != Word::Name || !peek().text.starts_with(begin))
            return refuse_word(begin.empty() ? "a name" : fmt::format("a name that begins with {}", begin));
        to = peek().text;
        ++at_;
        return true;
    }
    [[nodiscard]] bool number(std::uint64_t& to, std::uint64_t max) {
        const std::string& text = peek().text;
        const char* const end = text.data() + text.size();
        if (peek().kind != Word::Number || std::from_chars(text.data(), end, to).ptr != end ||
            std::from_chars(text.data(), end, to).ec != std::errc{} || to > max)
            return refuse_word(fmt::format("a number up to {}", max));
        ++at_;
        return true;
    }
    /// Of something new.
    [[nodiscard]] bool add_name(const std::string& name) {
        return names_.insert(name).second || refuse(fmt::format("{} is there already", name));
    }
    [[nodiscard]] bool add_type(const std::string& name) {
        types_.insert(name);
        return add_name(name);
    }
    [[nodiscard]] std::string take_doc() { return std::exchange(doc_, {}); }
    void read_docs() {
        for (; peek().kind == Word::Doc; ++at_) doc_ += (doc_.empty() ? "" : " ") + peek().text;
    }
    /// What stands before a member or behind it.
    [[nodiscard]] bool member_doc(std::string& to) {
        to = take_doc();
        if (peek().kind != Word::DocBehind) return true;
        if (!to.empty()) return refuse("expected documentation before or behind, and not both");
        to = peek().text;
        ++at_;
        return true;
    }

    [[nodiscard]] bool declaration() {
        read_docs();
        if (peek().kind == Word::Define) return constant();
        if (skip("DARKROOM_API")) return function();
        if (!skip("typedef")) return peek().kind == Word::End || refuse_word("typedef, DARKROOM_API or #define");
        if (is("enum")) return enumeration();
        if (is("const") || (is("struct") && peek(2).text != "{")) return handle();
        if (is("struct")) return structure();
        if (peek(1).text == "(") return callback();
        return alias();
    }

    [[nodiscard]] bool constant() {
        CConstant out{.name = peek().text, .doc = take_doc()};
        ++at_;
        // As C has it: a plain number has the type of the functions that return it.
        out.type = skip("UINT64_C") ? "uint64_t" : "uint32_t";
        if (!number(out.value, std::numeric_limits<std::int64_t>::max()) || !add_name(out.name)) return false;
        header_.constants.push_back(std::move(out));
        return true;
    }
    /// typedef [const] struct NAMEObject* NAME;
    [[nodiscard]] bool handle() {
        CHandle out{.doc = take_doc()};
        std::string tag;
        (void)skip("const");
        if (!expect("struct") || !name(tag) || !expect("*") || !name(out.name, "Darkroom")) return false;
        if (tag != out.name + "Object") return refuse(fmt::format("expected struct {}Object", out.name));
        if (!expect(";") || !add_type(out.name)) return false;
        header_.handles.push_back(std::move(out));
        return true;
    }
    [[nodiscard]] bool alias() {
        CAlias out{.doc = take_doc()};
        if (!is("uint64_t") && !is("uint32_t") && !is("int32_t")) return refuse_word("an integer's type");
        if (!name(out.type) || !name(out.name, "Darkroom") || !expect(";") || !add_type(out.name)) return false;
        header_.aliases.push_back(std::move(out));
        return true;
    }
    /// typedef enum NAME { VALUE = NUMBER, ... } NAME;
    [[nodiscard]] bool enumeration() {
        CEnum out{.doc = take_doc()};
        if (!expect("enum") || !name(out.name, "Darkroom") || !expect("{")) return false;
        bool is_last = false;
        while (!is("}")) {
            if (is_last) return refuse_word("',' or '}'");
            read_docs();
            CConstant value;
            if (!name(value.name, "DARKROOM_") || !add_name(value.name) || !expect("=") ||
                !number(value.value, std::numeric_limits<std::int32_t>::max()))
                return false;
            is_last = !skip(",");
            if (!member_doc(value.doc)) return false;
            out.values.push_back(std::move(value));
        }
        if (!check_count(out.values.size(), "values") || !end_of_body(out.name)) return false;
        header_.enums.push_back(std::move(out));
        return true;
    }
    /// typedef struct NAME { uint32_t struct_size; ... } NAME;
    [[nodiscard]] bool structure() {
        CStruct out{.doc = take_doc()};
        if (!expect("struct") || !name(out.name, "Darkroom") || !expect("{")) return false;
        if (!is("uint32_t") || peek(1).text != "struct_size") return refuse_word("uint32_t struct_size");
        while (!is("}")) {
            read_docs();
            CVariable member;
            if (!variable(member, false) || !expect(";") || !member_doc(member.doc)) return false;
            if (std::ranges::count(out.members, member.name, &CVariable::name) != 0)
                return refuse(fmt::format("{} is there already", member.name));
            out.members.push_back(std::move(member));
        }
        if (!check_count(out.members.size(), "members") || !end_of_body(out.name)) return false;
        header_.structs.push_back(std::move(out));
        return true;
    }
    [[nodiscard]] bool check_count(std::size_t count, std::string_view things) {
        if (count == 0 || count > max_items) return refuse(fmt::format("expected 1 to {} {}", max_items, things));
        return doc_.empty() || refuse(fmt::format("expected one of the {} behind its documentation", things));
    }
    [[nodiscard]] bool end_of_body(const std::string& name) {
        return expect("}") && expect(name) && expect(";") && add_type(name);
    }
    /// typedef RESULT (*NAME)(PARAMETERS);
    [[nodiscard]] bool callback() {
        CFunction out{.doc = take_doc()};
        if (!type(out.result) || !expect("(") || !expect("*") || !name(out.name, "Darkroom") || !expect(")") ||
            !parameters(out) || !add_type(out.name))
            return false;
        header_.callbacks.push_back(std::move(out));
        return true;
    }
    /// RESULT NAME(PARAMETERS);
    [[nodiscard]] bool function() {
        CFunction out{.doc = take_doc()};
        if (!type(out.result) || !name(out.name, "darkroom_") || !parameters(out) || !add_name(out.name)) return false;
        header_.functions.push_back(std::move(out));
        return true;
    }
    [[nodiscard]] bool parameters(CFunction& out) {
        if (!expect("(")) return false;
        if (is("void") && peek(1).text == ")") {
            ++at_;
        } else {
            do {
                CVariable parameter;
                if (!variable(parameter, true)) return false;
                if (out.parameters.size() == max_items) return refuse("these are too many parameters");
                out.parameters.push_back(std::move(parameter));
            } while (skip(","));
        }
        return expect(")") && expect(";");
    }
    /// TYPE NAME or TYPE NAME[LENGTH]
    [[nodiscard]] bool variable(CVariable& out, bool is_parameter) {
        if (!type(out.type) || !name(out.name)) return false;
        const bool is_array = skip("[");
        if (is_array) {
            std::uint64_t length = 0;
            if (!number(length, max_length) || length == 0 || !expect("]"))
                return refuse(fmt::format("expected a length of 1 to {}", max_length));
            out.type.length = static_cast<std::uint32_t>(length);
        }
        // Of a parameter that is an array, what it points to is const.
        if (out.type.is_const && out.type.stars.empty() && !(is_parameter && is_array))
            return refuse("expected no const without a pointer");
        return !is_void(out.type) || refuse("expected another type than void");
    }
    [[nodiscard]] bool type(CType& out) {
        out.is_const = skip("const");
        if (!types_.contains(peek().text) || peek().kind != Word::Name)
            return refuse_word("a type of C, of Vulkan (c_header.cpp) or of the header, declared before,");
        if (!name(out.name)) return false;
        while (skip("*")) out.stars.push_back(skip("const"));
        if (out.stars.size() > max_stars) return refuse(fmt::format("expected at most {} stars", max_stars));
        return out.stars.empty() || !out.stars.back() || refuse("expected no pointer that is const itself");
    }

    static bool is_void(const CType& type) { return type.name == "void" && type.stars.empty(); }

    std::vector<CToken> tokens_;
    std::size_t at_ = 0;
    std::set<std::string, std::less<>> types_, names_;
    CHeader header_;
    std::string doc_, fault_;
    std::size_t line_ = 0;
};

}  // namespace

Result<CHeader> parse_c_header(std::string_view text, std::string_view shown) {
    DARKROOM_TRY_VALUE(std::vector<CToken> tokens, c_tokens(text, shown));
    CParser parser(std::move(tokens));
    if (!parser.parse()) return c_error(text, shown, parser.line(), parser.fault());
    return std::move(parser).header();
}

std::string in_c(const CType& type) {
    std::string out = (type.is_const ? "const " : "") + type.name;
    for (const bool is_const : type.stars) out += is_const ? "* const" : "*";
    return out;
}

std::string in_c(const CVariable& variable) {
    const std::string end = variable.type.length != 0 ? fmt::format("[{}]", variable.type.length) : "";
    return fmt::format("{} {}{}", in_c(variable.type), variable.name, end);
}

namespace {

using Kind = VulkanType::Kind;
using Member = VulkanType::Member;

/// Of a type that is what it is said to be.
template <class T, Kind kind>
constexpr VulkanType type(std::string_view name) {
    static_assert(kind != Kind::Handle || (std::is_pointer_v<T> && sizeof(T) == sizeof(void*)));
    static_assert(kind != Kind::Function || std::is_pointer_v<T>);
    static_assert(kind != Kind::Object || sizeof(T) == 8);
    static_assert(kind != Kind::Enum || (std::is_enum_v<T> && sizeof(T) == 4));
    static_assert(kind != Kind::Integer || std::is_unsigned_v<T>);
    return {.name = name, .kind = kind, .size = sizeof(T)};
}
template <class T>
constexpr VulkanType composed(std::string_view name, std::span<const Member> members) {
    return {.name = name, .kind = Kind::Struct, .size = sizeof(T), .members = members};
}

static_assert(std::is_same_v<decltype(VkExtent2D{}.width), std::uint32_t> && sizeof(VkExtent2D) == 8);
constexpr Member extent[]{{"width", "uint32_t"}, {"height", "uint32_t"}};
static_assert(std::is_same_v<decltype(VkOffset2D{}.x), std::int32_t> && sizeof(VkOffset2D) == 8);
constexpr Member offset[]{{"x", "int32_t"}, {"y", "int32_t"}};
static_assert(offsetof(VkRect2D, extent) == sizeof(VkOffset2D) && sizeof(VkRect2D) == 16);
constexpr Member rectangle[]{{"offset", "VkOffset2D"}, {"extent", "VkExtent2D"}};

constexpr VulkanType types[]{
    type<VkInstance, Kind::Handle>("VkInstance"),
    type<VkPhysicalDevice, Kind::Handle>("VkPhysicalDevice"),
    type<VkDevice, Kind::Handle>("VkDevice"),
    type<VkCommandBuffer, Kind::Handle>("VkCommandBuffer"),
    type<VkImage, Kind::Object>("VkImage"),
    type<VkImageView, Kind::Object>("VkImageView"),
    type<VkBuffer, Kind::Object>("VkBuffer"),
    type<VkDeviceMemory, Kind::Object>("VkDeviceMemory"),
    type<VkPipelineCache, Kind::Object>("VkPipelineCache"),
    type<VkResult, Kind::Enum>("VkResult"),
    type<VkFormat, Kind::Enum>("VkFormat"),
    type<VkImageLayout, Kind::Enum>("VkImageLayout"),
    type<VkBool32, Kind::Integer>("VkBool32"),
    type<VkDeviceSize, Kind::Integer>("VkDeviceSize"),
    type<VkImageUsageFlags, Kind::Integer>("VkImageUsageFlags"),
    type<VkPipelineStageFlags2, Kind::Integer>("VkPipelineStageFlags2"),
    type<VkAccessFlags2, Kind::Integer>("VkAccessFlags2"),
    composed<VkOffset2D>("VkOffset2D", offset),
    composed<VkExtent2D>("VkExtent2D", extent),
    composed<VkRect2D>("VkRect2D", rectangle),
    type<PFN_vkGetInstanceProcAddr, Kind::Function>("PFN_vkGetInstanceProcAddr"),
    {.name = "VkPhysicalDeviceFeatures2", .kind = Kind::Opaque},
    {.name = "VkAllocationCallbacks", .kind = Kind::Opaque},
};

}  // namespace

std::span<const VulkanType> vulkan_types() { return types; }

std::string_view name_of(Kind kind) {
    switch (kind) {
        case Kind::Handle:
            return "handle";
        case Kind::Object:
            return "object";
        case Kind::Enum:
            return "enum";
        case Kind::Integer:
            return "integer";
        case Kind::Struct:
            return "struct";
        case Kind::Function:
            return "function";
        case Kind::Opaque:
            return "opaque";
    }
    return "";
}

}  // namespace app
