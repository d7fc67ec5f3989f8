// SPDX-License-Identifier: MIT
#include <darkroom/hud_document.hpp>
#include "hud/svg_process.hpp"
#include "tests/places.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

namespace darkroom {
namespace {

using Pixel = std::array<int, 4>;

Pixel pixel(const std::shared_ptr<const HudPicture>& picture, std::uint32_t x, std::uint32_t y) {
    if (picture == nullptr || x >= picture->width || y >= picture->height) return {-1, -1, -1, -1};
    const std::uint8_t* const at = picture->rgba.data() + 4 * (std::size_t{y} * picture->width + x);
    return {at[0], at[1], at[2], at[3]};
}

class HudDocuments : public testing::Test {
  protected:
    HudDocuments()
        : path_(std::filesystem::temp_directory_path() /
                (std::string("darkroom_hud_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
                 ".svg")) {}
    ~HudDocuments() override { std::filesystem::remove(path_); }

    void write(const std::string& inside) const {
        std::ofstream(path_) << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"10\" height=\"10\">\n"
                             << inside << "\n</svg>\n";
        // As later as it takes for the clock of the file's folder to tell.
        static int seconds = 0;
        std::filesystem::last_write_time(
            path_, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++seconds));
    }
    [[nodiscard]] std::unique_ptr<HudDocument> load(const HudOptions& options = {.is_headless = true}) const {
        auto loaded = HudDocument::load(path_, options);
        EXPECT_TRUE(loaded) << loaded.error().text;
        return loaded ? std::move(*loaded) : nullptr;
    }
    [[nodiscard]] std::string refusal(const HudOptions& options = {.is_headless = true}) const {
        const auto loaded = HudDocument::load(path_, options);
        return loaded ? std::string() : loaded.error().text;
    }
    [[nodiscard]] std::string at(const std::string& line) const { return path_.string() + ":" + line; }

    std::filesystem::path path_;
};

/// Turbulence upon turbulence.
std::string slow_filter() {
    std::string out = "<filter id='slow' x='0' y='0' width='1' height='1'>";
    for (int i = 0; i < 1000; ++i) out += "<feTurbulence baseFrequency='0.1' numOctaves='20'/>";
    return out + "</filter><rect width='10' height='10' filter='url(#slow)'/>";
}

TEST_F(HudDocuments, IsPremultipliedRedFirstFromTheTop) {
    write("<rect width='10' height='5' fill='#ff8000' fill-opacity='0.5'/>");
    const auto document = load();
    const auto picture = document->picture(20, 20);
    ASSERT_NE(picture, nullptr) << document->error();
    EXPECT_EQ(picture->rgba.size(), 1600u);
    const Pixel above = pixel(picture, 10, 4);
    EXPECT_NEAR(above[0], 128, 1);
    EXPECT_NEAR(above[1], 64, 1);
    EXPECT_EQ(above[2], 0);
    EXPECT_NEAR(above[3], 128, 1);
    EXPECT_EQ(pixel(picture, 10, 15), (Pixel{0, 0, 0, 0}));
}

TEST_F(HudDocuments, IsDrawnForItsSizeAndItsValuesAlone) {
    write("<rect width='{{health}}' height='10' fill='#0f0'/>");
    const auto document = load();
    document->set("health", 5.0);
    document->set("unnamed", 1.0);
    const auto half = document->picture(10, 10);
    ASSERT_NE(half, nullptr) << document->error();
    EXPECT_EQ(pixel(half, 4, 5), (Pixel{0, 255, 0, 255}));
    EXPECT_EQ(pixel(half, 6, 5), (Pixel{0, 0, 0, 0}));
    document->set("health", 5.0);
    document->set("unnamed", 2.0);
    EXPECT_EQ(document->picture(10, 10), half);
    EXPECT_EQ(document->drawings(), 1u);
    document->set("health", 8.0);
    EXPECT_EQ(pixel(document->picture(10, 10), 6, 5), (Pixel{0, 255, 0, 255}));
    EXPECT_EQ(document->picture(20, 10)->width, 20u);
    EXPECT_EQ(document->drawings(), 3u);
    document->set("health", std::nan(""));
    (void)document->picture(20, 10);
    const std::uint64_t drawings = document->drawings();
    document->set("health", std::nan(""));
    (void)document->picture(20, 10);
    EXPECT_EQ(document->drawings(), drawings);
}

TEST_F(HudDocuments, AClassChangesWhatStylesSay) {
    write("<style>.low { fill: #f00; }</style><rect id='bar' width='10' height='10' fill='#0f0'/>");
    const auto document = load();
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{0, 255, 0, 255}));
    EXPECT_TRUE(document->set_class("bar", "low", true));
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{255, 0, 0, 255}));
    EXPECT_TRUE(document->set_class("bar", "low", true));
    const auto same = document->picture(10, 10);
    EXPECT_EQ(document->drawings(), 2u);
    EXPECT_TRUE(document->set_class("bar", "low", false));
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{0, 255, 0, 255}));
    for (const std::string& name : {std::string(), std::string("a b"), std::string("\"/><x"), std::string(65, 'a')}) {
        EXPECT_FALSE(document->set_class("bar", name, true)) << name;
        EXPECT_FALSE(document->set_class(name, "low", true)) << name;
    }
    int taken = 0;
    for (int i = 0; i < 1000; ++i) taken += document->set_class("bar", "c" + std::to_string(i), true) ? 1 : 0;
    EXPECT_EQ(taken, 255) << "and the one above";
}

TEST_F(HudDocuments, UnknownNamesAreAnErrorUntilTheyAreSet) {
    write("<text>{{health}}</text>");
    const auto document = load();
    document->set("heath", 5.0);
    EXPECT_EQ(document->picture(10, 10), nullptr);
    EXPECT_EQ(document->error(), at("2: {{health}}: no value has this name, did you mean 'heath'?"));
    document->set("health", 5.0);
    EXPECT_NE(document->picture(10, 10), nullptr);
    EXPECT_EQ(document->error(), "");
}

TEST_F(HudDocuments, ComesAnewFromItsFile) {
    write("<rect width='10' height='10' fill='#f00'/>");
    const auto document = load();
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{255, 0, 0, 255}));
    write("<rect width='10' height='10' fill='#00f'/>");
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{0, 0, 255, 255}));
}

TEST_F(HudDocuments, ABrokenFileLeavesTheLastGoodOne) {
    write("<rect width='{{health}}' height='10' fill='#f00'/>");
    const auto document = load();
    document->set("health", 5.0);
    EXPECT_EQ(pixel(document->picture(10, 10), 2, 5), (Pixel{255, 0, 0, 255}));
    for (const auto& [broken, line] : {std::pair{"\n<g><rect></g>", "3: "},
                                       {"<image href='file:///a.png'/>", "2: "},
                                       {"<text>{{unheard_of}}</text>", "2: "},
                                       {"<g>", "3: "},
                                       {"<g x='1' x='2'/>", "2: "}}) {
        write(broken);
        (void)document->picture(10, 10);
        EXPECT_TRUE(document->error().starts_with(at(line))) << document->error();
        EXPECT_EQ(std::ranges::count(document->error(), '\n'), 0);
        document->set("health", 3.0);
        EXPECT_EQ(pixel(document->picture(10, 10), 4, 5), (Pixel{0, 0, 0, 0})) << "the last good one is not alive";
        EXPECT_NE(document->error(), "") << "forgotten while it holds";
        document->set("health", 5.0);
        EXPECT_EQ(pixel(document->picture(10, 10), 4, 5), (Pixel{255, 0, 0, 255}));
    }
    std::filesystem::remove(path_);
    EXPECT_EQ(pixel(document->picture(10, 10), 4, 5), (Pixel{255, 0, 0, 255}));
    EXPECT_NE(document->error(), "");
    write("<rect width='10' height='10' fill='#00f'/>");
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{0, 0, 255, 255}));
    EXPECT_EQ(document->error(), "");
}

TEST_F(HudDocuments, HostileOnesAreRefused) {
    std::filesystem::remove(path_);
    EXPECT_NE(refusal().find("there is no such file"), std::string::npos) << refusal();
    std::ofstream(path_) << "<!DOCTYPE svg [<!ENTITY a SYSTEM \"file:///etc/passwd\">]>\n<svg><text>&a;</text></svg>";
    EXPECT_TRUE(refusal().starts_with(at("1: "))) << refusal();
    write(std::string(5000, ' '));
    EXPECT_NE(refusal({.limits = {.document_bytes = 4096}}), "");
    std::string many;
    for (int i = 0; i < 100; ++i) many += "<g/>";
    write(many);
    EXPECT_EQ(refusal({.limits = {.elements = 50}}), at("2: more than 50 elements"));

    write("<g/>");
    const auto document = load({.is_headless = true, .limits = {.side = 100, .pixels = 5000}});
    for (const auto& [width, height] : {std::pair{0u, 10u}, {10u, 0u}, {101u, 10u}, {80u, 80u}, {~0u, ~0u}}) {
        EXPECT_EQ(document->picture(width, height), nullptr);
        EXPECT_NE(document->error().find("allowed is [1, 100] a side, at most 5000 pixels"), std::string::npos)
            << document->error();
    }
    EXPECT_NE(document->picture(70, 70), nullptr) << document->error();
}

TEST_F(HudDocuments, ManyReferencesToReferencesEnd) {
    std::string defs = "<defs><rect id='a0' width='1' height='1'/>";
    for (int i = 0; i < 30; ++i) {
        const std::string below = std::to_string(i);
        defs += "<g id='a" + std::to_string(i + 1) + "'><use href='#a" + below + "'/><use href='#a" + below + "'/></g>";
    }
    write(defs + "</defs><use href='#a30'/>");
    const auto document = load();
    EXPECT_EQ(document->picture(10, 10), nullptr);
    EXPECT_NE(document->error(), "");
}

TEST_F(HudDocuments, WhatTakesTooLongIsGivenUp) {
    write(slow_filter());
    const auto document = load({.is_headless = true, .limits = {.seconds = 1}});
    EXPECT_EQ(document->picture(1000, 1000), nullptr);
    EXPECT_EQ(document->error(), path_.string() + ": it takes more than 1 s or too much memory to draw");
    write("<rect width='10' height='10' fill='#f00'/>");
    EXPECT_EQ(pixel(document->picture(10, 10), 5, 5), (Pixel{255, 0, 0, 255})) << document->error();
}

TEST_F(HudDocuments, IsDrawnOffTheFrameLoop) {
    write("<rect width='{{health}}' height='10' fill='#f00'/>");
    const auto document = load({.poll_seconds = 0});
    document->set("health", 10.0);
    EXPECT_EQ(document->picture(10, 10), nullptr) << "it waited";
    const auto wait_for = [&](std::uint64_t drawings) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (document->drawings() < drawings && std::chrono::steady_clock::now() < end) {
            (void)document->picture(10, 10);
            std::this_thread::yield();
        }
        return document->picture(10, 10);
    };
    const auto first = wait_for(1);
    EXPECT_EQ(pixel(first, 5, 5), (Pixel{255, 0, 0, 255})) << document->error();
    document->set("health", 2.0);
    EXPECT_EQ(document->picture(10, 10), first) << "it waited";
    EXPECT_EQ(pixel(wait_for(2), 5, 5), (Pixel{0, 0, 0, 0}));
    EXPECT_EQ(document->drawings(), 2u);
}

TEST_F(HudDocuments, LeavingDoesNotWaitForALongDrawing) {
    write(slow_filter());
    auto document = load({.limits = {.seconds = 60}});
    (void)document->picture(1000, 1000);
    const auto start = std::chrono::steady_clock::now();
    document.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

// What it may not do, tests/confine_test.cpp tries.
TEST(HudProcess, IsConfinedBeforeItReads) {
    SvgProcess process;
    ASSERT_TRUE(process.draw("<svg xmlns='http://www.w3.org/2000/svg'><text y='9'>a</text></svg>", 10, 10));
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream stream(entry.path() / "status");
        const std::string status{std::istreambuf_iterator<char>(stream), {}};
        if (!status.starts_with("Name:\tdarkroom_svg\n") ||
            status.find("\nPPid:\t" + std::to_string(::getpid()) + "\n") == std::string::npos)
            continue;
        ++found;
        EXPECT_NE(status.find("\nNoNewPrivs:\t1\n"), std::string::npos) << status;
        EXPECT_NE(status.find("\nSeccomp:\t2\n"), std::string::npos) << status;
    }
    EXPECT_EQ(found, 1u);
}

// The picture is copied out of memory that has one size.
TEST(HudProcess, PicturesOfManySizesFollowEachOther) {
    SvgProcess process;
    const std::string document =
        "<svg xmlns='http://www.w3.org/2000/svg' width='100%' height='100%'>"
        "<rect width='100%' height='100%' fill='lime'/></svg>";
    for (const auto& [width, height] : {std::pair(64U, 64U), std::pair(2000U, 1000U), std::pair(1U, 1U),
                                        std::pair(7680U, 4320U), std::pair(300U, 200U)}) {
        const auto picture = process.draw(document, width, height);
        ASSERT_TRUE(picture) << picture.error().text;
        const auto shared = std::make_shared<const HudPicture>(*picture);
        EXPECT_EQ(pixel(shared, 0, 0), (Pixel{0, 255, 0, 255}));
        EXPECT_EQ(pixel(shared, width - 1, height - 1), (Pixel{0, 255, 0, 255}));
    }
}

TEST(HudProcess, ADrawingCanBeCancelled) {
    const std::string start = "<svg xmlns='http://www.w3.org/2000/svg' width='10' height='10'>";
    SvgProcess process({.seconds = 60});
    ASSERT_TRUE(process.draw(start + "</svg>", 10, 10));
    bool is_drawn = true;
    const auto begin = std::chrono::steady_clock::now();
    std::thread drawing([&] { is_drawn = process.draw(start + slow_filter() + "</svg>", 1000, 1000).has_value(); });
    process.cancel();
    drawing.join();
    EXPECT_FALSE(is_drawn);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(HudVisor, ShowsItsValues) {
    auto visor = HudDocument::load(std::string(test::source_folder) + "/hud/visor.svg", {.is_headless = true});
    ASSERT_TRUE(visor) << visor.error().text;
    const auto with = [&](double health, double heading) {
        for (const auto& [name, value] :
             {std::pair{"health", health}, {"heading", heading}, {"ammunition", 24.0}, {"reserve", 180.0}})
            (*visor)->set(name, value);
        (*visor)->set("weapon", std::string("RAIL"));
        return (*visor)->picture(960, 540);
    };
    const auto lit = [](const std::shared_ptr<const HudPicture>& picture, std::uint32_t left, std::uint32_t top,
                        std::uint32_t right, std::uint32_t bottom) {
        int count = 0;
        for (std::uint32_t y = top; y < bottom; ++y)
            for (std::uint32_t x = left; x < right; ++x) count += pixel(picture, x, y)[1] > 128 ? 1 : 0;
        return count;
    };
    const auto full = with(100, 0), low = with(20, 0), turned = with(20, 90);
    ASSERT_NE(turned, nullptr) << (*visor)->error();
    // The bar of health is at the lower left, the compass at the top, the crosshair in the middle.
    EXPECT_GT(lit(full, 56, 461, 206, 469), 3 * lit(low, 56, 461, 206, 469));
    EXPECT_GT(lit(low, 56, 461, 206, 469), 0);
    EXPECT_NE(lit(low, 380, 25, 580, 50), 0);
    EXPECT_NE(lit(low, 380, 25, 580, 50), lit(turned, 380, 25, 580, 50));
    EXPECT_GT(lit(low, 460, 250, 500, 290), 40);
    EXPECT_EQ(lit(low, 460, 150, 500, 200), 0);
    // Right where the ammunition is.
    EXPECT_GT(lit(low, 800, 400, 920, 470), 100);
}

}  // namespace
}  // namespace darkroom
