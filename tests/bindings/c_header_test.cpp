// SPDX-License-Identifier: MIT
// What `darkroom_lab api` reads of the header is all that stands in it, and what it does not understand is an error.
#include <regex>

#include "lab/api/c_header.hpp"
#include "programs/darkroom/run/json.hpp"
#include "tests/cli/lab_support.hpp"

namespace darkroom {
namespace {

using app::CHeader;
using app::parse_c_header;
using test::Outcome;

/// One of each that the header may hold.
constexpr std::string_view all_forms = R"(/* SPDX-License-Identifier: MIT */
#ifndef DARKROOM_H
#define DARKROOM_H
// A comment.
#include <stdint.h>
#if defined(_WIN32)
#define DARKROOM_API __declspec(dllexport)
#else
union passed_over {};
#endif
/// Ten.
#define DARKROOM_TEN 10
#define DARKROOM_FAR UINT64_C(4294967295)
typedef enum DarkroomResult {
    DARKROOM_OK = 0,
    DARKROOM_ERROR = 7  ///< wrong
} DarkroomResult;
/// A thing,
/// or another.
typedef struct DarkroomThingObject* DarkroomThing;
typedef const struct DarkroomSightObject* DarkroomSight;
typedef uint64_t DarkroomHandle;
typedef struct DarkroomDesc {
    uint32_t struct_size;
    char name[256];           ///< of the thing
    const char* const* list;
    /// Where.
    VkRect2D region;
    void* user;
} DarkroomDesc;
typedef void (*DarkroomLog)(void* user, const DarkroomDesc* desc);
/// The number.
DARKROOM_API uint32_t darkroom_version(void);
DARKROOM_API DarkroomResult darkroom_thing_move(DarkroomThing thing, const float matrix[16], float out[2],
                                                const void** bytes);
#endif
)";

TEST(CHeaderReader, ReadsEveryForm) {
    const Result<CHeader> read = parse_c_header(all_forms, "all.h");
    ASSERT_TRUE(read) << read.error().text;
    ASSERT_EQ(read->constants.size(), 2U);
    EXPECT_EQ(read->constants[0].name, "DARKROOM_TEN");
    EXPECT_EQ(read->constants[0].value, 10U);
    EXPECT_EQ(read->constants[0].doc, "Ten.");
    EXPECT_EQ(read->constants[0].type, "uint32_t");
    EXPECT_EQ(read->constants[1].value, 4294967295U);
    EXPECT_EQ(read->constants[1].type, "uint64_t");
    ASSERT_EQ(read->enums.size(), 1U);
    ASSERT_EQ(read->enums[0].values.size(), 2U);
    EXPECT_EQ(read->enums[0].values[1].name, "DARKROOM_ERROR");
    EXPECT_EQ(read->enums[0].values[1].value, 7U);
    EXPECT_EQ(read->enums[0].values[1].doc, "wrong");
    ASSERT_EQ(read->handles.size(), 2U);
    EXPECT_EQ(read->handles[0].doc, "A thing, or another.");
    EXPECT_EQ(read->handles[1].name, "DarkroomSight");
    ASSERT_EQ(read->aliases.size(), 1U);
    EXPECT_EQ(read->aliases[0].type, "uint64_t");
    ASSERT_EQ(read->structs.size(), 1U);
    std::vector<std::string> members;
    for (const app::CVariable& member : read->structs[0].members) members.push_back(in_c(member));
    EXPECT_EQ(members, (std::vector<std::string>{"uint32_t struct_size", "char name[256]", "const char* const* list",
                                                 "VkRect2D region", "void* user"}));
    EXPECT_EQ(read->structs[0].members[1].doc, "of the thing");
    EXPECT_EQ(read->structs[0].members[3].doc, "Where.");
    ASSERT_EQ(read->callbacks.size(), 1U);
    EXPECT_EQ(in_c(read->callbacks[0].parameters[1]), "const DarkroomDesc* desc");
    ASSERT_EQ(read->functions.size(), 2U);
    EXPECT_EQ(read->functions[0].doc, "The number.");
    EXPECT_TRUE(read->functions[0].parameters.empty());
    EXPECT_EQ(in_c(read->functions[1].result), "DarkroomResult");
    EXPECT_EQ(in_c(read->functions[1].parameters[1]), "const float matrix[16]");
    EXPECT_EQ(in_c(read->functions[1].parameters[3]), "const void** bytes");
}

TEST(CHeaderReader, RefusesASlipByItsLine) {
    const std::vector<std::pair<std::string, std::string>> slips{
        {"union U { int a; };",
         "slip.h:2: 'union U { int a; };': expected typedef, DARKROOM_API or #define at 'union'"},
        {"typedef float DarkroomNumber;", "an integer's type at 'float'"},
        {"typedef struct DarkroomA { uint32_t size; } DarkroomA;", "expected uint32_t struct_size at 'uint32_t'"},
        {"typedef struct DarkroomA { uint32_t struct_size; int a; } DarkroomA;", "declared before, at 'int'"},
        {"typedef struct DarkroomA { uint32_t struct_size; DarkroomB b; } DarkroomA;",
         "declared before, at 'DarkroomB'"},
        {"typedef struct DarkroomA { uint32_t struct_size; VkSampler s; } DarkroomA;",
         "declared before, at 'VkSampler'"},
        {"typedef struct DarkroomA { uint32_t struct_size; void v; } DarkroomA;", "expected another type than void"},
        {"typedef struct DarkroomA { uint32_t struct_size; const float v; } DarkroomA;", "no const without a pointer"},
        {"typedef struct DarkroomA { uint32_t struct_size; float a, b; } DarkroomA;", "expected ';' at ','"},
        {"typedef struct DarkroomA { uint32_t struct_size; float a[0]; } DarkroomA;", "a length of 1 to 65536"},
        {"typedef struct DarkroomA { uint32_t struct_size; float a[65537]; } DarkroomA;", "a number up to 65536"},
        {"typedef struct DarkroomA { uint32_t struct_size; float a; float a; } DarkroomA;", "a is there already"},
        {"typedef struct DarkroomA { uint32_t struct_size; } DarkroomB;", "expected 'DarkroomA' at 'DarkroomB'"},
        {"typedef struct DarkroomA { uint32_t struct_size;", "expected a type of C, of Vulkan"},
        {"typedef struct DarkroomA { uint32_t struct_size; uint32_t b : 1; } DarkroomA;", "and not ':'"},
        {"typedef enum DarkroomA { DARKROOM_B } DarkroomA;", "expected '=' at '}'"},
        {"typedef enum DarkroomA { DARKROOM_B = 1 DARKROOM_C = 2 } DarkroomA;", "expected ',' or '}' at 'DARKROOM_C'"},
        {"typedef enum DarkroomA { DARKROOM_B = 2147483648 } DarkroomA;", "a number up to 2147483647"},
        {"typedef enum DarkroomA { } DarkroomA;", "expected 1 to 1000 values"},
        {"typedef struct DarkroomBObject* DarkroomA;", "expected struct DarkroomAObject"},
        {"typedef void (*DarkroomA)(int a);", "declared before, at 'int'"},
        {"DARKROOM_API void darkroom_a();", "declared before, at ')'"},
        {"DARKROOM_API void darkroom_a(char* const a);", "no pointer that is const itself"},
        {"DARKROOM_API void darkroom_a(char**** a);", "at most 3 stars"},
        {"DARKROOM_API void a(void);", "a name that begins with darkroom_ at 'a'"},
        {"DARKROOM_API void darkroom_a(void) DARKROOM_API", "expected ';' at 'DARKROOM_API'"},
        {"DARKROOM_API void darkroom_a(void); DARKROOM_API void darkroom_a(void);", "darkroom_a is there already"},
        {"void darkroom_a(void);", "expected typedef, DARKROOM_API or #define at 'void'"},
        {"#define DARKROOM_TEN (5 + 5)", "expected #define NAME NUMBER"},
        {"#define DARKROOM_FAR 9223372036854775808", "a number up to 9223372036854775807"},
        {"#pragma once", "expected #if, #endif, #include or #define"},
        {"#if 1", "a #if has no #endif"},
        {"#endif", "a #endif has no #if"},
        {"/* two", "a comment of this kind takes one line"},
        {"typedef enum DarkroomA {\n/// Before.\nDARKROOM_B = 1 ///< behind\n} DarkroomA;",
         "before or behind, and not both"},
        {"/// Of nothing.", "expected a declaration behind its documentation"},
        {"\x1b[31m", "slip.h:2: '\\x1B[31m': expected a name, a number or one of {}()[];,*= and not '\\x1B'"},
    };
    for (const auto& [slip, part] : slips) {
        const Result<CHeader> read = parse_c_header("// The first line.\n" + slip + "\n", "slip.h");
        ASSERT_FALSE(read) << slip;
        EXPECT_NE(read.error().text.find(part), std::string::npos) << read.error().text << "\nof " << slip;
        EXPECT_TRUE(read.error().text.starts_with("slip.h:")) << read.error().text;
        EXPECT_EQ(read.error().text.find('\n'), std::string::npos) << read.error().text;
    }
    EXPECT_FALSE(parse_c_header(std::string((1 << 20) + 1, ' '), "long.h"));
}

TEST(CHeaderReader, AnyPartOfTheHeaderIsReadOrRefused) {
    const std::string whole = test::content(std::filesystem::path(test::source_folder) / "include/darkroom/darkroom.h");
    ASSERT_TRUE(parse_c_header(whole, "darkroom.h"));
    std::size_t refused = 0, tried = 0;
    for (std::size_t at = 0; at < whole.size(); at += 211, ++tried) {
        const Result<CHeader> begun = parse_c_header(std::string_view(whole).substr(0, at), "darkroom.h");
        std::string changed = whole;
        changed[at] = '@';
        const Result<CHeader> other = parse_c_header(changed, "darkroom.h");
        for (const Result<CHeader>* const read : {&begun, &other})
            if (!*read) {
                ++refused;
                EXPECT_EQ(read->error().text.find('\n'), std::string::npos) << read->error().text;
            }
    }
    EXPECT_GT(tried, 150U);
    EXPECT_GT(refused, tried);
}

class CliApi : public test::WithLab<test::CliFixture> {
  protected:
    [[nodiscard]] app::Json document() const {
        const Outcome outcome = run({"api", "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return app::Json::parse(outcome.out).value_or(app::Json());
    }
};

TEST_F(CliApi, HasAllThatTheHeaderDeclares) {
    const std::string header =
        test::content(std::filesystem::path(test::source_folder) / "include/darkroom/darkroom.h");
    const app::Json json = document();
    const auto expect_all = [&](const char* list, const std::regex& pattern) {
        std::set<std::string> there, expected;
        ASSERT_NE(json.find(list), nullptr) << list;
        for (const app::Json& one : json.find(list)->elements()) there.insert(one.find("name")->text());
        for (std::sregex_iterator at(header.begin(), header.end(), pattern), end; at != end; ++at)
            expected.insert((*at)[1]);
        EXPECT_GE(there.size(), 2U) << list;
        EXPECT_EQ(there, expected) << list;
    };
    expect_all("functions", std::regex("\nDARKROOM_API [^;(]*\\b(darkroom_[a-z0-9_]+)\\("));
    expect_all("structs", std::regex("\ntypedef struct (Darkroom[A-Za-z]+) \\{"));
    expect_all("enums", std::regex("\ntypedef enum (Darkroom[A-Za-z]+) \\{"));
    expect_all("handles", std::regex("\ntypedef (?:const )?struct Darkroom[A-Za-z]+\\* (Darkroom[A-Za-z]+);"));
    expect_all("callbacks", std::regex("\ntypedef [A-Za-z]+ \\(\\*(Darkroom[A-Za-z]+)\\)"));
    expect_all("aliases", std::regex("\ntypedef uint64_t (Darkroom[A-Za-z]+);"));
    expect_all("constants", std::regex("\n#define (DARKROOM_[A-Z_]+) (?:[0-9]|UINT64_C)"));
}

TEST_F(CliApi, HasTheEffectsAsTheirOwnCommandHasThem) {
    const app::Json json = document();
    const std::optional<app::Json> effects = app::Json::parse(run({"effects", "--json"}).out);
    ASSERT_TRUE(effects && json.find("effects") != nullptr);
    EXPECT_GT(effects->size(), 0U);
    EXPECT_EQ(json.find("effects")->dump(), effects->dump());
    EXPECT_EQ(json.find("version")->text(), test::project_version);
}

TEST_F(CliApi, ListsForPeople) {
    const Outcome outcome = run({"api"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(
        outcome.out.find("\nDarkroomResult darkroom_device_create(const DarkroomDeviceDesc* desc, DarkroomDevice* "
                         "device)\n    Creates a headless device."),
        std::string::npos)
        << outcome.out;
    expect_refused({"api", "more"}, 1, "more");
}

}  // namespace
}  // namespace darkroom
