// SPDX-License-Identifier: MIT
// The lines of a file, one by one: what describes the effect, and which function's each line of code is.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <darkroom/effect.hpp>

#include "core/text/param_text.hpp"
#include "custom/description.hpp"
#include "custom/light.hpp"
#include "custom/words.hpp"
#include "plan/frame_inputs.hpp"
#include "plan/text/glsl_names.hpp"

namespace darkroom::custom {

namespace {

constexpr Names<Touch, 2> touches{{{"pointwise", Touch::Pointwise}, {"warp", Touch::Warp}}};
constexpr Names<Domain, 3> domains{
    {{"scene_linear", Domain::SceneLinear}, {"display_linear", Domain::DisplayLinear}, {"encoded", Domain::Encoded}}};
constexpr auto needs = [] {
    Names<FrameImage, frame_image_count> out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {plan::frame_inputs[i].name, plan::frame_inputs[i].image};
    return out;
}();
constexpr std::string_view second_name = "second";

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

Result<> read_effect(Description& out, std::string_view text) {
    if (!out.info.name.empty()) return user_error("a second @effect; a file holds one");
    DARKROOM_TRY_VALUE(const auto halves, with_sentence(text));
    DARKROOM_TRY(check_name(halves.head));
    if (plan::is_function_name(halves.head) || pascal_name(halves.head) == "Curve")
        return user_error(fmt::format("{}: a name of GLSL or of the kernels", halves.head));
    if (find_effect(halves.head) != nullptr)
        return user_error(fmt::format("{}: the name of an effect that is built in; choose another", halves.head));
    out.info.name = out.keep(halves.head);
    out.info.doc = out.keep(halves.rest);
    return {};
}

Result<> read_touch(Description& out, std::string_view text) {
    const auto touch = named(touches, text);
    if (!touch) return user_error(fmt::format("@touch {}: allowed is {}", printable(text), listed(touches)));
    out.info.touch = *touch;
    return {};
}

Result<> read_accepts(Description& out, std::string_view text) {
    out.info.accepts = {};
    do {
        const std::string_view name = next_word(text);
        const auto domain = named(domains, name);
        if (!domain) return user_error(fmt::format("@accepts {}: allowed is {}", printable(name), listed(domains)));
        out.info.accepts = out.info.accepts | Domains::only(*domain);
    } while (!text.empty());
    return {};
}

template <Domain domain>
ColorState makes(ColorState before, const void*) {
    if (domain == Domain::Encoded) return srgb_color;
    return {.domain = domain, .white_nits = before.white_nits, .peak_nits = before.peak_nits};
}

Result<> read_makes(Description& out, std::string_view text) {
    const auto domain = named(domains, text);
    if (!domain) return user_error(fmt::format("@makes {}: allowed is {}", printable(text), listed(domains)));
    constexpr std::array functions{makes<Domain::SceneLinear>, makes<Domain::DisplayLinear>, makes<Domain::Encoded>};
    out.info.makes = functions[static_cast<std::size_t>(*domain)];
    return {};
}

Result<> read_needs(Description& out, std::string_view text) {
    do {
        const std::string_view name = next_word(text);
        const auto need = named(needs, name);
        if (!need && name != second_name)
            return user_error(fmt::format("@needs {}: allowed is {}, {}", printable(name), listed(needs), second_name));
        if (need)
            out.info.needs.add(*need);
        else
            out.info.second = Second::Image;
    } while (!text.empty());
    return {};
}

using Reader = Result<> (*)(Description&, std::string_view);
template <FileImage::Kind kind>
Result<> read_image_of(Description& out, std::string_view text) {
    return read_image(out, kind, text);
}
constexpr Names<Reader, 13> head_readers{{{"@effect", read_effect},
                                          {"@param", read_parameter},
                                          {"@touch", read_touch},
                                          {"@accepts", read_accepts},
                                          {"@makes", read_makes},
                                          {"@needs", read_needs},
                                          {"@image", read_image_of<FileImage::Kind::Image>},
                                          {"@history", read_image_of<FileImage::Kind::History>},
                                          {"@table", read_image_of<FileImage::Kind::Table>},
                                          {"@buffer", declare_buffer},
                                          {"@value", declare_value},
                                          {"@result", read_result},
                                          {"@pre_roll", read_pre_roll}}};
constexpr std::string_view pass_word = "@pass", compute_word = "@compute", end_word = "@end", table_word = "@table";

/// What a comment line says; empty: the line is code, or none of ours.
std::string_view comment_of(std::string_view line) { return line.starts_with("//") ? trimmed(line.substr(2)) : ""; }

/// Some editors begin a file with the mark of UTF-8.
std::string_view without_mark(std::string_view text) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

class FileReader {
  public:
    FileReader(Description& out, std::string_view text, std::string_view shown_name)
        : out_(out), text_(without_mark(text)), shown_name_(printable(shown_name)) {
        // It stands in quotes in the text that is compiled.
        for (char& c : shown_name_)
            if (c == '"' || c == '\\') c = '_';
    }

    Result<> run() {
        Result<> done = read();
        if (done) return done;
        return user_error(fmt::format("{}:{}: {}", shown_name_, line_, done.error().text));
    }

  private:
    Result<> read() {
        line_ = 1;
        if (text_.find('\0') != std::string_view::npos) return user_error("a zero byte; allowed is text");
        DARKROOM_TRY_VALUE(auto code, expand_code(text_, line_));
        constexpr std::string_view effect_word = "@effect ";
        std::string name;
        for (std::size_t at = code.find(effect_word); name.empty() && at != std::string::npos;
             at = code.find(effect_word, at + 1)) {
            const std::size_t begin = code.rfind('\n', at) + 1;
            const std::string_view line = std::string_view(code).substr(begin, code.find('\n', at) - begin);
            if (!line.starts_with("//") || trimmed(line.substr(2, at - begin - 2)).size() != 0) continue;
            const std::string_view named = line.substr(at - begin + effect_word.size());
            name = trimmed(named.substr(0, named.find(':')));
        }
        split_lines(out_.keep(check_name(name) ? with_own_names(code, name) : code));
        DARKROOM_TRY(read_lines());
        line_ = 1;
        if (out_.info.name.empty()) return user_error("no line `// @effect NAME: SENTENCE.` before the code");
        DARKROOM_TRY(check_passes(out_));
        if (out_.result.empty() && !out_.end) {
            if (!out_.passes.empty())
                return user_error(
                    fmt::format("passes without an end or a result: expected `// @end IMAGE` above the function {}, "
                                "or `// @result IMAGE`",
                                out_.info.name));
            out_.end = FileFunction{.line = 1};
        }
        struct_name_ = out_.keep(pascal_name(out_.info.name));
        for (std::size_t i = 0; i < out_.passes.size(); ++i) DARKROOM_TRY(add_pass_text(out_.passes[i], i + 1));
        if (out_.end) DARKROOM_TRY(add_end_text(*out_.end));
        out_.info.files = out_.files;
        out_.info.parameters = {struct_name_, out_.rows, out_.defaults};
        return {};
    }

    void split_lines(std::string_view code) {
        while (!code.empty()) {
            const std::size_t end = code.find('\n');
            lines_.push_back(code.substr(0, end));
            code = end == std::string_view::npos ? std::string_view{} : code.substr(end + 1);
        }
    }

    Result<> read_lines() {
        constexpr std::size_t common = 0;
        std::size_t owner = common;
        bool is_head = true;
        for (line_ = 1; line_ <= lines_.size(); ++line_) {
            const std::string_view content = trimmed(lines_[line_ - 1]);
            std::string_view comment = comment_of(content);
            if (comment.starts_with('@')) {
                const std::string_view word = next_word(comment);
                if (word == pass_word || word == compute_word || word == end_word) {
                    is_head = false;
                    DARKROOM_TRY(begin_function(word, comment));
                    owner = word == end_word ? end_owner : out_.passes.size();
                } else
                    DARKROOM_TRY(read_head(word, comment, is_head));
            }
            is_head &= content.empty() || content.starts_with("//");
            owners_.push_back(owner);
        }
        return {};
    }

    Result<> begin_function(std::string_view word, std::string_view text) {
        if (word == end_word) {
            if (out_.end) return user_error("a second @end; an effect has one");
            DARKROOM_TRY_VALUE(auto end, read_end(out_, text));
            end.line = line_;
            out_.end = std::move(end);
            return {};
        }
        DARKROOM_TRY_VALUE(auto pass, word == compute_word ? read_compute(out_, text) : read_pass(out_, text));
        pass.line = line_;
        out_.passes.push_back(std::move(pass));
        return {};
    }

    Result<> read_head(std::string_view word, std::string_view text, bool is_head) {
        const auto reader = named(head_readers, word);
        if (!reader)
            return user_error(fmt::format("{}: allowed is {}, {}, {}, {}", printable(word), listed(head_readers),
                                          pass_word, compute_word, end_word));
        if (!is_head) return user_error(fmt::format("{}: stands above the code, the passes and the end", word));
        if (word != table_word) return (*reader)(out_, text);
        // The values of a table go on in the next line as long as one ends in a comma.
        std::string whole(text);
        while (trimmed(whole).ends_with(',') && line_ < lines_.size()) {
            const std::string_view next = comment_of(trimmed(lines_[line_]));
            if (next.empty() || next.starts_with('@')) break;
            whole.append(next);
            ++line_;
            owners_.push_back(0);
        }
        return (*reader)(out_, whole);
    }

    /// The lines that are the function's own or everyone's; the others are empty, so that numbers stay true.
    [[nodiscard]] std::string text_of(std::size_t owner) const {
        std::string out;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (owners_[i] == 0 || owners_[i] == owner) out += lines_[i];
            out += '\n';
        }
        return out;
    }

    /// `form`: how its function is declared.
    Result<> add_text(FileFunction& function, const std::string& name, const std::string& form, std::string code) {
        DARKROOM_TRY(read_shared(function, code, line_));
        line_ = function.line;
        if (!plan::calls_name(code, name)) return user_error(fmt::format("no function {}: expected `{}`", name, form));
        DARKROOM_TRY(check_struct(code, name, struct_name_, form, line_));
        DARKROOM_TRY(check_stage(code, function.is_compute, line_));
        line_ = function.line;
        function.reads_light = out_.info.needs.contains(FrameImage::Shadows) && reads_light(code, out_.info.name);
        if (function.reads_light)
            code = fmt::format("{}#line 1 \"{}\"\n{}", light_code(out_.info.name, !function.name.empty()), shown_name_,
                               code);
        DARKROOM_TRY(read_uses(out_, function, code));
        function.shader = out_.keep(name + ".glsl");
        if (!function.name.empty())
            code += fmt::format("#line {} \"{}\"\n{}\n", function.line, shown_name_, main_of(function, name));
        out_.files.push_back({function.shader, out_.keep(code), out_.keep(shown_name_)});
        return {};
    }

    /// What the kernel calls, from the function of the file.
    [[nodiscard]] std::string main_of(const FileFunction& function, const std::string& name) const {
        if (function.is_compute) return fmt::format("void run() {{ {}({}_parameters()); }}", name, out_.info.name);
        if (function.outputs.size() == 1)
            return fmt::format("vec4 shade(Pixel pixel) {{ return {}(pixel, {}_parameters()); }}", name,
                               out_.info.name);
        return fmt::format("void shade(Pixel pixel, out vec4 result[{}]) {{ {}(pixel, {}_parameters(), result); }}",
                           function.outputs.size(), name, out_.info.name);
    }

    Result<> add_pass_text(FileFunction& pass, std::size_t owner) {
        const std::string name = fmt::format("{}_{}", out_.info.name, pass.name);
        const std::string form = pass.is_compute ? fmt::format("void {}({} parameters)", name, struct_name_)
                                 : pass.outputs.size() == 1
                                     ? fmt::format("vec4 {}(Pixel pixel, {} parameters)", name, struct_name_)
                                     : fmt::format("void {}(Pixel pixel, {} parameters, out vec4 result[{}])", name,
                                                   struct_name_, pass.outputs.size());
        return add_text(pass, name, form, text_of(owner));
    }
    Result<> add_end_text(FileFunction& end) {
        const std::string name(out_.info.name);
        return add_text(end, name,
                        fmt::format("vec4 {}({}Pixel pixel, {} parameters)", name,
                                    out_.info.touch == Touch::Warp ? "" : "vec4 color, ", struct_name_),
                        text_of(end_owner));
    }

    static constexpr std::size_t end_owner = ~std::size_t{0};
    Description& out_;
    std::string_view text_, struct_name_;
    std::string shown_name_;
    std::vector<std::string_view> lines_;
    std::vector<std::size_t> owners_;  ///< of each line: 0 for everyone, the number of a pass from 1, or end_owner
    std::size_t line_ = 1;
};

}  // namespace

Result<> check_name(std::string_view name) {
    if (!plan::is_snake_name(name))
        return user_error(
            fmt::format("{}: a name is made of lower-case letters, digits and single underscores, and begins with a "
                        "letter",
                        printable(name)));
    if (plan::is_glsl_keyword(name)) return user_error(fmt::format("{}: a keyword of GLSL", name));
    return {};
}

Result<Halves> with_sentence(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view sentence =
        colon == std::string_view::npos ? std::string_view{} : trimmed(text.substr(colon + 1));
    if (sentence.empty() || sentence.back() != '.')
        return user_error(
            fmt::format("{}: expected a colon and a sentence that ends with a full stop", printable(text)));
    return Halves{trimmed(text.substr(0, colon)), sentence};
}

Result<> read_description(Description& out, std::string_view text, std::string_view shown_name) {
    return FileReader(out, text, shown_name).run();
}

}  // namespace darkroom::custom
