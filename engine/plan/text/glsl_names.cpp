// SPDX-License-Identifier: MIT
#include "plan/text/glsl_names.hpp"

#include <algorithm>
#include <array>

#include "gpu/shader/glsl_scan.hpp"

namespace darkroom::plan {

namespace {

// In order, for the search. Words with capitals are left out: no snake_case name is one.
constexpr auto keywords = std::to_array<std::string_view>(
    {"active",   "asm",       "atomic_uint", "attribute", "bool",      "break",    "buffer",        "bvec2",
     "bvec3",    "bvec4",     "case",        "cast",      "centroid",  "class",    "coherent",      "common",
     "const",    "continue",  "default",     "discard",   "dmat2",     "dmat2x2",  "dmat2x3",       "dmat2x4",
     "dmat3",    "dmat3x2",   "dmat3x3",     "dmat3x4",   "dmat4",     "dmat4x2",  "dmat4x3",       "dmat4x4",
     "do",       "double",    "dvec2",       "dvec3",     "dvec4",     "else",     "enum",          "extern",
     "external", "false",     "filter",      "fixed",     "flat",      "float",    "for",           "fvec2",
     "fvec3",    "fvec4",     "goto",        "half",      "highp",     "hvec2",    "hvec3",         "hvec4",
     "if",       "in",        "inline",      "inout",     "input",     "int",      "interface",     "invariant",
     "ivec2",    "ivec3",     "ivec4",       "layout",    "long",      "lowp",     "main",          "mat2",
     "mat2x2",   "mat2x3",    "mat2x4",      "mat3",      "mat3x2",    "mat3x3",   "mat3x4",        "mat4",
     "mat4x2",   "mat4x3",    "mat4x4",      "mediump",   "namespace", "noinline", "noperspective", "out",
     "output",   "partition", "patch",       "precise",   "precision", "public",   "readonly",      "resource",
     "restrict", "return",    "sample",      "sampler",   "shared",    "short",    "sizeof",        "smooth",
     "static",   "struct",    "subroutine",  "superp",    "switch",    "template", "texture",       "this",
     "true",     "typedef",   "uint",        "uniform",   "union",     "unsigned", "using",         "uvec2",
     "uvec3",    "uvec4",     "varying",     "vec2",      "vec3",      "vec4",     "void",          "volatile",
     "while",    "writeonly"});
constexpr auto functions = std::to_array<std::string_view>(
    {"abs",     "acos",    "all",          "any",   "asin",       "atan",          "barrier",    "ceil",
     "clamp",   "color",   "cos",          "cross", "custom",     "degrees",       "distance",   "dot",
     "equal",   "exp",     "exp2",         "floor", "fma",        "fract",         "gather_red", "inversesqrt",
     "length",  "load",    "load_clamped", "log",   "log2",       "max",           "min",        "mix",
     "mod",     "modf",    "normalize",    "not",   "parameters", "picture",       "pixel",      "pow",
     "radians", "reflect", "refract",      "round", "run",        "sample_linear", "shade",      "sign",
     "sin",     "size",    "sqrt",         "step",  "store",      "tan",           "transpose",  "trunc"});
static_assert(std::ranges::is_sorted(keywords) && std::ranges::is_sorted(functions));

bool is_letter(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

bool is_snake_name(std::string_view name) {
    if (name.empty() || name.size() > 48 || !is_letter(name.front()) || name.back() == '_') return false;
    if (name.find("__") != std::string_view::npos || name.starts_with("gl_")) return false;
    return std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

bool is_glsl_keyword(std::string_view name) { return std::ranges::binary_search(keywords, name); }
bool is_function_name(std::string_view name) { return std::ranges::binary_search(functions, name); }

bool calls_name(std::string_view text, std::string_view name) {
    gpu::GlslScanner scanner(text);
    for (gpu::Token token = scanner.next(); token.kind != gpu::Token::Kind::End; token = scanner.next())
        if (token.kind == gpu::Token::Kind::Word && token.text == name && scanner.peek().text == "(") return true;
    return false;
}

}  // namespace darkroom::plan
