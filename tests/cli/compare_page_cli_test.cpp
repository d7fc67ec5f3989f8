// SPDX-License-Identifier: MIT
// The page that `darkroom compare --html` writes: what is on it and in which order, what its pictures hold, what it
// cannot be made to say.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/exr/test_exr.hpp"
#include "image/picture/write.hpp"
#include "scene/gltf/container.hpp"

namespace darkroom {
namespace {

using test::Outcome;

constexpr std::uint32_t page_width = 23, page_height = 11;

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
    return count;
}

class CliComparePage : public test::CliFixture {
  protected:
    void make_files() override {
        for (const std::string folder : {"a", "b"}) std::filesystem::create_directory(path(folder));
    }
    /// Codes of 8 bits, no two neighbours alike.
    [[nodiscard]] static Picture codes(int added = 0, std::uint32_t across = page_width) {
        Picture out(across, page_height);
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            out.pixels[i] = static_cast<float>(static_cast<int>(i * 37 % 191) + added) / 255;
        return out;
    }
    void write_pair(const std::string& name, int added) const {
        ASSERT_TRUE(write_picture(path("a/" + name), codes()));
        ASSERT_TRUE(write_picture(path("b/" + name), codes(added)));
    }
    [[nodiscard]] std::string page(const std::string& a, const std::string& b, int code = 0,
                                   std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"compare", path(a), path(b), "--html", path("page.html")});
        const Outcome outcome = run(more);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        return test::content(path("page.html"));
    }
    /// The pictures of this class, in their order, as a browser reads them.
    [[nodiscard]] std::vector<Picture> pictures(const std::string& page, const std::string& name) const {
        std::vector<Picture> out;
        const std::string start = "<img class=\"" + name + "\"";
        for (std::size_t at = page.find(start); at != std::string::npos; at = page.find(start, at + 1)) {
            const std::size_t uri = page.find("src=\"", at) + 5;
            const auto bytes = scene::gltf::decode_data_uri(page.substr(uri, page.find('"', uri) - uri));
            EXPECT_TRUE(bytes) << name;
            if (!bytes) continue;
            write("decoded.png", std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
            out.push_back(picture("decoded.png"));
        }
        return out;
    }
};

TEST_F(CliComparePage, HoldsThePicturesOfTheFiles) {
    write_pair("x.png", 3);
    const std::string text = page("a/x.png", "b/x.png", 3, {"--fail-max", "0.01"});
    EXPECT_EQ(pictures(text, "before"), std::vector<Picture>{picture("a/x.png")});
    EXPECT_EQ(pictures(text, "after"), std::vector<Picture>{picture("b/x.png")});
    // 3/255 times 64: twice that is above 1.
    const std::vector<Picture> differences = pictures(text, "difference");
    ASSERT_EQ(differences.size(), 1U);
    ASSERT_EQ(differences[0].width, page_width);
    for (std::size_t i = 0; i < differences[0].pixels.size(); ++i)
        ASSERT_NEAR(differences[0].pixels[i], i % 4 == 3 ? 1.0F : 3 * 64 / 255.0F, 1e-6) << i;
    EXPECT_NE(text.find("difference, times 64<"), std::string::npos);
    ASSERT_EQ(run({"compare", path("a/x.png"), path("b/x.png"), "--diff", path("flip.png")}).code, 0);
    EXPECT_EQ(pictures(text, "flip"), std::vector<Picture>{picture("flip.png")});
    EXPECT_EQ(count_of(text, "class=\"bad\">fails<"), 2U) << "in the table and over the pictures";
    EXPECT_NE(text.find("max error"), std::string::npos) << "why it fails";
    EXPECT_EQ(text, page("a/x.png", "b/x.png", 3, {"--fail-max", "0.01"})) << "the same bytes again";
}

// Whoever opens it needs no network, and a picture's name runs no script.
TEST_F(CliComparePage, NeedsNothingFromElsewhere) {
    write_pair("x.png", 3);
    const std::string text = page("a/x.png", "b/x.png");
    for (const char* const part : {"http:", "https:", "<link", "@import", "url(", "src=\"/", "src=\"file"})
        EXPECT_EQ(text.find(part), std::string::npos) << part;
    EXPECT_EQ(count_of(text, "src=\""), 4U);
    EXPECT_EQ(count_of(text, "src=\"data:image/png;base64,"), 4U);
    EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
    EXPECT_NE(text.find("prefers-color-scheme: dark"), std::string::npos);
}

TEST_F(CliComparePage, TheWorstComeFirstAndWhatIsEqualIsALine) {
    write_pair("a_little.png", 1);
    write_pair("b_equal.png", 0);
    write_pair("c_most.png", 60);
    write_pair("d_some.png", 20);
    ASSERT_TRUE(write_picture(path("a/e_wide.png"), codes(0, page_width + 1)));
    ASSERT_TRUE(write_picture(path("b/e_wide.png"), codes()));
    ASSERT_TRUE(write_picture(path("b/f_new.png"), codes()));
    const std::string text = page("a", "b", 1);
    EXPECT_EQ(count_of(text, "<section"), 3U);
    std::size_t last = 0;
    for (const char* const part : {"4 compared", "<li>" /* the pair that cannot be compared */, "f_new.png", "<table",
                                   ">c_most.png</a>", ">d_some.png</a>", ">a_little.png</a>", "<td>b_equal.png</td>",
                                   "<h2>c_most.png", "<h2>d_some.png", "<h2>a_little.png"}) {
        const std::size_t at = text.find(part);
        EXPECT_NE(at, std::string::npos) << part;
        EXPECT_GT(at, last) << part;
        last = at;
    }
    EXPECT_EQ(count_of(text, "b_equal.png"), 1U);
    EXPECT_NE(text.find("23x11"), std::string::npos);
}

TEST_F(CliComparePage, ManyPairsAreRowsWithoutPictures) {
    for (int i = 0; i < 26; ++i) write_pair("p" + std::to_string(10 + i) + ".png", 1 + i);
    const std::string text = page("a", "b");
    EXPECT_EQ(count_of(text, "<section"), 24U);
    EXPECT_NE(text.find("2 pairs that differ have no pictures here"), std::string::npos);
    for (const char* const name : {"p10.png", "p11.png"}) {
        EXPECT_EQ(text.find("<h2>" + std::string(name)), std::string::npos) << "the least bad";
        EXPECT_NE(text.find("<td>" + std::string(name) + "</td>"), std::string::npos);
    }
    EXPECT_LT(text.find("<h2>p35.png"), text.find("<h2>p34.png"));
}

TEST_F(CliComparePage, NamesAreTextWhateverTheyHold) {
    const std::string name = "\"><script>alert(1)<b>' & \n.png";
    write_pair(name, 3);
    const std::string text = page("a", "b");
    EXPECT_EQ(text.find("<script>alert"), std::string::npos);
    EXPECT_EQ(text.find("<b>'"), std::string::npos);
    EXPECT_NE(text.find("&quot;&gt;&lt;script&gt;alert(1)&lt;b&gt;&apos; &amp; \\x0A.png"), std::string::npos);
    EXPECT_EQ(count_of(text, "<script>"), 1U);
}

TEST_F(CliComparePage, WhatIsNotFiniteIsMagenta) {
    std::vector<float> values(std::size_t{page_width} * page_height * 3, 0.25F);
    values[3 * 4] = std::numeric_limits<float>::quiet_NaN();
    test::store_floats(path("a/n.exr"), {"R", "G", "B"}, page_width, values);
    values[3 * 6 + 1] = std::numeric_limits<float>::infinity();
    test::store_floats(path("b/n.exr"), {"R", "G", "B"}, page_width, values);
    const std::string text = page("a/n.exr", "b/n.exr", 3);
    const auto color = [&](const char* kind, std::uint32_t x) {
        const std::vector<Picture> found = pictures(text, kind);
        EXPECT_EQ(found.size(), 1U);
        if (found.size() != 1) return std::vector<float>{};
        return std::vector<float>(found[0].at(x, 0), found[0].at(x, 0) + 3);
    };
    const std::vector<float> magenta{1, 0, 1}, black{0, 0, 0};
    EXPECT_EQ(color("before", 4), magenta);
    EXPECT_EQ(color("after", 4), magenta);
    EXPECT_EQ(color("difference", 4), black) << "the same in both";
    EXPECT_EQ(color("difference", 5), black);
    EXPECT_EQ(color("difference", 6), magenta);
    // 0.25, sRGB-encoded: 0.5371 (IEC 61966-2-1).
    EXPECT_EQ(color("before", 5), std::vector<float>(3, 137 / 255.0F));
    EXPECT_NE(text.find("linear light"), std::string::npos);
}

TEST_F(CliComparePage, RefusedBeforeAnythingIsWritten) {
    write_pair("x.png", 3);
    ASSERT_TRUE(write_picture(path("b/wide.png"), codes(0, page_width + 1)));
    const std::string a = path("a/x.png"), b = path("b/x.png");
    expect_refused({"compare", a, b, "--html", path("page.png")}, 1, "unknown extension .png; .html .htm");
    expect_refused({"compare", a, b, "--html", path("none/page.html")}, 1, "none");
    expect_refused({"compare", a, b, "--html", path("page.html"), "--layers", "depth"}, 1, "--html");
    expect_refused({"compare", a, path("b/wide.png"), "--html", path("page.html")}, 1, "23x11 and 24x11");
    expect_refused({"compare", a, b, "--html", path("page.html"), "--sheet", path("sheet.txt")}, 1, ".txt");
    EXPECT_EQ(run({"compare", a, b, "--html", path("none/page.html"), "--mkdir"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(path("none/page.html")));
}

}  // namespace
}  // namespace darkroom
