// SPDX-License-Identifier: MIT
// What the code of a file says, read as tokens: which images it names, and what it must not say.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/text/param_text.hpp"
#include "custom/description.hpp"
#include "custom/words.hpp"
#include "gpu/shader/glsl_scan.hpp"
#include "plan/frame_inputs.hpp"
#include "plan/text/glsl_names.hpp"

namespace darkroom::custom {

namespace {

using gpu::Token;

/// Words with which a shader declares what it reads and writes, or how it runs.
constexpr std::array<std::string_view, 9> refused_words{"attribute", "buffer", "layout",     "main",   "sampler2D",
                                                        "shade",     "shared", "subroutine", "uniform"};
/// What GLSL has in shaders of one stage alone. A device runs functions in the stage that suits it.
constexpr std::array<std::string_view, 16> fragment_words{
    "discard",  "dFdx",          "dFdxCoarse",     "dFdxFine",      "dFdy",         "dFdyCoarse",
    "dFdyFine", "fwidth",        "fwidthCoarse",   "fwidthFine",    "gl_FragCoord", "gl_FragDepth",
    "gl_Layer", "gl_PointCoord", "gl_PrimitiveID", "gl_FrontFacing"};
constexpr std::array<std::string_view, 9> compute_words{
    "barrier",        "gl_GlobalInvocationID", "gl_LocalInvocationID", "gl_LocalInvocationIndex", "gl_NumWorkGroups",
    "gl_WorkGroupID", "gl_WorkGroupSize",      "groupMemoryBarrier",   "memoryBarrierShared"};
/// A value goes wherever its name stands, so it is short: text cannot grow without bound.
constexpr std::size_t longest_value = 120;
/// The compiler walks the tree of an expression by recursion: one of 7000 nested calls ends the process.
constexpr std::size_t longest_statement = 2000;

/// Compilers put a function's code wherever it is called, and take a minute for four times as many.
constexpr std::size_t most_written_out = 65536;
/// A buffer has no more numbers, and compilers take a minute for a million.
constexpr std::size_t longest_array = 4096;

/// Calls visit(token, the mark or word before, the one before that) for every token that is not blank.
template <class Visit>
void for_each_token(std::string_view code, const Visit& visit) {
    gpu::GlslScanner scanner(code);
    Token last, last_but_one;
    for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
        if (token.kind == Token::Kind::Blank) continue;
        visit(token, last, last_but_one);
        last_but_one = last;
        last = token;
    }
}

bool names_word(std::string_view code, std::string_view name) {
    bool is_named = false;
    for_each_token(code, [&](const Token& token, const Token&, const Token&) {
        is_named |= token.kind == Token::Kind::Word && token.text == name;
    });
    return is_named;
}

/// What stands for a name from its line on.
struct Define {
    std::string_view name;
    std::string value;
    std::size_t line = 0;
};

bool is_refused(std::string_view word) { return std::ranges::find(refused_words, word) != refused_words.end(); }
Result<> refuse_word(std::string_view word) {
    return user_error(
        fmt::format("{}: the kernel around the file's functions declares its images and its main "
                    "function; allowed are functions, structs and constants",
                    word));
}

/// Without its comments, which would hide what follows the name that it stands for.
Result<std::string> read_value(std::string_view name, std::string_view text) {
    std::string value;
    gpu::GlslScanner scanner(text);
    for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
        if (token.kind == Token::Kind::Directive || (token.text.starts_with("/*") && !token.text.ends_with("*/")))
            return user_error(fmt::format("#define {}: its value does not end in its line", printable(name)));
        if (is_refused(token.text)) return failure(refuse_word(token.text));
        value += token.text.starts_with("//") || token.text.starts_with("/*") ? " " : token.text;
    }
    return std::string(trimmed(value));
}

/// `#include "shared/camera.glsl"` and `#define NAME VALUE`.
Result<std::optional<Define>> read_directive(std::string_view text, std::size_t line) {
    std::string_view rest = text.substr(1);
    const std::string_view word = next_word(rest);
    if (word == "include" && rest.starts_with("\"shared/")) return std::nullopt;
    if (word != "define")
        return user_error(
            fmt::format("{}: allowed is `#include \"shared/NAME.glsl\"` and `#define NAME VALUE`", printable(text)));
    const std::string_view name = next_word(rest);
    if (name.find('(') != std::string_view::npos)
        return user_error(
            fmt::format("#define {}: expected a name without parameters; write a function", printable(name)));
    if (rest.size() > longest_value)
        return user_error(
            fmt::format("#define {}: a value of at most {} characters is allowed", printable(name), longest_value));
    DARKROOM_TRY_VALUE(auto value, read_value(name, rest));
    return Define{name, std::move(value), line};
}

std::size_t count_words_and_marks(std::string_view code) {
    std::size_t count = 0;
    for_each_token(code, [&](const Token&, const Token&, const Token&) { ++count; });
    return count;
}

/// A value is put in once: it names no other.
Result<> check_values(std::span<const Define> defines, std::size_t& line) {
    std::set<std::string_view> names;
    for (const Define& define : defines) names.insert(define.name);
    for (const Define& define : defines)
        for (const std::string_view name : names)
            if (names_word(define.value, name)) {
                line = define.line;
                return user_error(fmt::format("#define {}: its value names {}, another one", printable(define.name),
                                              printable(name)));
            }
    return {};
}

/// Functions as they are once those that they call are written out in them.
class WrittenOut {
  public:
    explicit WrittenOut(std::string_view code) {
        std::size_t depth = 0;
        std::string_view name;
        Body* body = nullptr;
        for_each_token(code, [&](const Token& token, const Token& last, const Token&) {
            const bool is_called = token.text == "(" && last.kind == Token::Kind::Word;
            if (is_called && body == nullptr) name = last.text;
            if (is_called && body != nullptr) body->calls.push_back(last.text);
            if (token.text == "{" && depth++ == 0 && last.text == ")") body = &functions_[name].emplace_back();
            if (token.text == "}" && depth > 0 && --depth == 0) body = nullptr;
            if (body != nullptr) ++body->words;
        });
    }

    /// The name of one that is longer than allowed; empty: none is.
    std::string_view too_long() {
        for (auto& [name, bodies] : functions_)
            if (size_of(bodies) > most_written_out) return name;
        return {};
    }

  private:
    struct Body {
        std::size_t words = 0;
        std::vector<std::string_view> calls;
        bool is_written_out = false;
    };

    // What calls itself is refused by GLSL; until then it counts once.
    std::size_t size_of(std::vector<Body>& bodies) {
        std::size_t most = 0;
        for (Body& body : bodies) {
            if (!std::exchange(body.is_written_out, true))
                for (const std::string_view call : body.calls)
                    if (const auto called = functions_.find(call); called != functions_.end())
                        body.words = std::min(body.words + size_of(called->second), most_written_out + 1);
            most = std::max(most, body.words);
        }
        return most;
    }

    std::map<std::string_view, std::vector<Body>> functions_;
};

/// The elements of arrays, those in structs counted through; a length that is no plain number is 1.
class Arrays {
  public:
    explicit Arrays(std::string_view code) {
        for_each_token(code, [&](const Token& token, const Token&, const Token&) { tokens_.push_back(token); });
        std::string_view structure;
        std::size_t elements = 0, of_type = 1;
        while (at_ < tokens_.size()) {
            const Token token = tokens_[at_++];
            if (token.text == "struct" && text() != "{") {
                structure = text();
                elements = 0;
            } else if (token.text == "}" && !structure.empty()) {
                sizes_[structure] = elements;
                structure = {};
            } else if (token.kind == Token::Kind::Word) {
                const auto known = sizes_.find(token.text);
                const std::size_t own = (known == sizes_.end() ? 1 : known->second) * lengths();
                if (at_ < tokens_.size() && tokens_[at_].kind == Token::Kind::Word) {
                    of_type = own;
                    ++at_;
                    const std::size_t all = note(own * lengths());
                    if (!structure.empty()) elements += all;
                } else {
                    note(own);
                }
            } else if (token.text == "," && !structure.empty()) {
                ++at_;
                elements += note(of_type * lengths());
            }
            elements = note(elements);
        }
    }
    [[nodiscard]] std::size_t largest() const { return largest_; }

  private:
    [[nodiscard]] std::string_view text() const {
        return at_ < tokens_.size() ? tokens_[at_].text : std::string_view();
    }
    /// Of what stands here, "[4][3]": 12, with a limit that products stay below.
    std::size_t lengths() {
        std::size_t product = 1;
        while (text() == "[") {
            const std::string number(at_ + 1 < tokens_.size() ? tokens_[at_ + 1].text : std::string_view());
            const bool is_plain = at_ + 2 < tokens_.size() && tokens_[at_ + 2].text == "]";
            if (!is_plain) break;
            at_ += 3;
            product = std::min(product * std::max<std::size_t>(std::strtoull(number.c_str(), nullptr, 0), 1), enough);
        }
        return product;
    }
    std::size_t note(std::size_t elements) {
        largest_ = std::max(largest_, elements);
        return std::min(elements, enough);
    }

    static constexpr std::size_t enough = std::size_t{1} << 20;
    std::vector<Token> tokens_;
    std::size_t at_ = 0, largest_ = 0;
    std::map<std::string_view, std::size_t> sizes_;  // of structs
};

/// What takes compilers more than a minute: much code, once calls are written out, and large arrays.
Result<> check_size(std::string_view code) {
    if (const std::string_view name = WrittenOut(code).too_long(); !name.empty())
        return user_error(
            fmt::format("{}: a function of more than {} words and marks, those of all that it calls included", name,
                        most_written_out));
    if (Arrays(code).largest() > longest_array)
        return user_error(fmt::format("an array of more than {} elements, those of structs included", longest_array));
    return {};
}

}  // namespace

Result<std::string> expand_code(std::string_view text, std::size_t& line) {
    std::string out;
    std::vector<Define> defines;
    std::map<std::string_view, std::string> values;
    gpu::GlslScanner scanner(text);
    std::size_t statement = 0;
    line = 1;
    for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
        // A line that goes on in the next would part what is read here from what is compiled.
        if (token.text == "\\" || (token.text.ends_with('\\') && token.kind != Token::Kind::Blank))
            return user_error("a backslash: GLSL has no use for one here");
        // What is shared belongs to a compute pass: read_shared() looks at that.
        if (token.kind == Token::Kind::Word && token.text != "shared" && is_refused(token.text))
            return failure(refuse_word(token.text));
        const auto value = token.kind == Token::Kind::Word || token.kind == Token::Kind::Member
                               ? values.find(token.text)
                               : values.end();
        if (token.kind == Token::Kind::Directive) {
            DARKROOM_TRY_VALUE(auto define, read_directive(token.text, line));
            if (define) {
                values[define->name] = define->value;
                defines.push_back(std::move(*define));
            } else {
                out += token.text;
            }
        } else {
            out += value == values.end() ? token.text : std::string_view(value->second);
        }
        if (token.text == ";" || token.text == "{" || token.text == "}")
            statement = 0;
        else if (token.kind != Token::Kind::Blank)
            statement += value == values.end() ? 1 : count_words_and_marks(value->second);
        if (statement > longest_statement)
            return user_error(fmt::format("a statement of more than {} words and marks", longest_statement));
        line += static_cast<std::size_t>(std::ranges::count(token.text, '\n'));
    }
    DARKROOM_TRY(check_values(defines, line));
    line = 1;  // of the whole file
    DARKROOM_TRY(check_size(out));
    return out;
}

std::string with_own_names(std::string_view code, std::string_view effect) {
    const auto is_one_of = [](std::string_view text, std::string_view marks) {
        return text.size() == 1 && marks.find(text) != std::string_view::npos;
    };
    std::set<std::string_view> names, words;
    std::string out;
    // Names of GLSL and of kernels stay theirs: a file may have a further form of one.
    const auto is_others = [](std::string_view name) {
        return plan::is_glsl_keyword(name) || plan::is_function_name(name);
    };
    const auto own_name = [&](std::string_view name) {
        std::string plain = fmt::format("{}_{}", effect, name);
        return name.starts_with('_') || words.contains(plain) ? fmt::format("{}_0{}", effect, name) : plain;
    };
    // Twice: which names the file gives, then in their places. Names of members stay, as they do behind a dot.
    for (const bool is_renaming : {false, true}) {
        gpu::GlslScanner scanner(code);
        Token last;
        std::size_t depth = 0;
        bool is_struct = false, is_shared = false;  // what is shared belongs to one pass alone
        for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
            const bool is_word = token.kind == Token::Kind::Word;
            const bool is_declared = is_word && is_one_of(scanner.peek().text, depth == 0 ? "(=[;," : "[;,") &&
                                     (last.kind == Token::Kind::Word || is_one_of(last.text, "],"));
            const bool is_member = depth > 0 && is_struct && is_declared;
            if (is_word) words.insert(token.text);
            if (is_renaming) {
                if (is_word && !is_member && names.contains(token.text))
                    out += own_name(token.text);
                else
                    out += token.text;
            } else if (depth == 0 && !is_others(token.text) && !is_shared && is_word &&
                       (is_declared || last.text == "struct") && token.text != effect &&
                       !token.text.starts_with(std::string(effect) + "_")) {
                names.insert(token.text);
            }
            if (token.kind == Token::Kind::Blank || token.kind == Token::Kind::Directive) continue;
            if (depth == 0 && is_one_of(token.text, ";{")) is_struct &= token.text == "{";
            is_struct |= depth == 0 && token.text == "struct";
            is_shared = depth == 0 && token.text == ";" ? false : is_shared || token.text == "shared";
            if (is_one_of(token.text, "({[")) ++depth;
            if (is_one_of(token.text, ")}]") && depth > 0) --depth;
            last = token;
        }
    }
    return out;
}

// A struct of another name is an error of the GLSL compiler, which does not know the name that was meant.
Result<> check_struct(std::string_view code, std::string_view function, std::string_view struct_name,
                      std::string_view form, std::size_t& line) {
    std::size_t at = 1, first = 0, open = 0;
    bool is_named = false, is_closed = false;
    gpu::GlslScanner scanner(code);
    for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
        if (open > 0 && token.text == "(") ++open;
        if (open > 0 && token.text == ")") is_closed |= --open == 0;
        if (open > 0) is_named |= token.kind == Token::Kind::Word && token.text == struct_name;
        if (open == 0 && token.kind == Token::Kind::Word && token.text == function && scanner.peek().text == "(") {
            if (first == 0) first = at;
            for (token = scanner.next(); token.text != "("; token = scanner.next())
                at += static_cast<std::size_t>(std::ranges::count(token.text, '\n'));
            open = 1;
        }
        at += static_cast<std::size_t>(std::ranges::count(token.text, '\n'));
    }
    if (is_named || !is_closed) return {};
    line = first;
    return user_error(
        fmt::format("{}: the struct of its parameters is {}: expected `{}`", function, struct_name, form));
}

Result<> check_stage(std::string_view code, bool is_compute, std::size_t& line) {
    const auto is_one_of = [](std::span<const std::string_view> words, std::string_view word) {
        return std::ranges::find(words, word) != words.end();
    };
    std::size_t at = 1;
    gpu::GlslScanner scanner(code);
    for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
        const bool is_word = token.kind == Token::Kind::Word;
        if (is_word && is_one_of(fragment_words, token.text)) {
            line = at;
            return user_error(
                fmt::format("{}: GLSL has it in fragment shaders alone, and this code may run in others", token.text));
        }
        if (is_word && !is_compute && is_one_of(compute_words, token.text)) {
            line = at;
            return user_error(
                fmt::format("{}: GLSL has it in compute shaders alone; allowed is it in the function of "
                            "a `@compute`",
                            token.text));
        }
        at += static_cast<std::size_t>(std::ranges::count(token.text, '\n'));
    }
    return {};
}

Result<> read_uses(const Description& from, FileFunction& function, std::string_view code) {
    for (const plan::FrameInput& input : plan::frame_inputs) {
        if (!names_word(code, input.shader_name)) continue;
        if (!from.info.needs.contains(input.image))
            return user_error(fmt::format("{}: read without `@needs {}`", input.shader_name, input.name));
        function.inputs.push_back(input.shader_name);
    }
    if (function.inputs.size() > max_inputs)
        return user_error(fmt::format("{} images are read, of the frame and of the file; at most {} are allowed",
                                      function.inputs.size(), max_inputs));
    return {};
}

}  // namespace darkroom::custom
