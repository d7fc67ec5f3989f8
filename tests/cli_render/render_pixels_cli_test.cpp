// SPDX-License-Identifier: MIT
// Which pixels the flags of `darkroom render` change, and to what: a yard of two boxes is traced by rays, so that for
// every pixel it is known what it shows, whether the sun reaches it and what lies beside it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "image/frame/frame_file.hpp"
#include "scene/math.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using scene::vec2;
using scene::vec3;
using test::Outcome;

constexpr std::uint32_t wide = 96, tall = 64;
constexpr scene::Box floor_box{{-3, 0.01F, -3}, {3, 0.05F, 3}}, box{{-0.6F, 0.05F, -0.6F}, {0.6F, 1.2F, 0.6F}};

/// Nothing spreads light from pixel to pixel: without bloom and occlusion a picture is its light through one curve.
constexpr const char* yard = R"([scene]
name = "Yard"
[camera]
position = [1, 3, 6]
target = [0, 0.5, 0]
fov = 50
[environment]
background = [0.1, 0.2, 0.4]
[post_process]
exposure = 0.25
bloom_enabled = false
ssao_enabled = false
[entities.sun.light]
direction = [-1, 1.1, 0.5]
intensity = 12
[entities.floor]
bounds = { min = [-3, 0.01, -3], max = [3, 0.05, 3] }
material = { color = [0.6, 0.6, 0.6], roughness = 1 }
[entities.box]
bounds = { min = [-0.6, 0.05, -0.6], max = [0.6, 1.2, 0.6] }
material = { color = [0.8, 0.3, 0.1], roughness = 1 }
)";
const vec3 toward_sun = glm::normalize(vec3(-1, 1.1F, 0.5F));

struct Hit {
    float distance = std::numeric_limits<float>::infinity();  ///< in lengths of the ray's direction
    vec3 normal{0};
    [[nodiscard]] bool is_sky() const { return std::isinf(distance); }
};

Hit trace(const scene::Box& target, vec3 from, vec3 direction) {
    float enter = 1e-4F, leave = std::numeric_limits<float>::infinity();
    vec3 normal(0);
    for (int axis = 0; axis < 3; ++axis) {
        const float a = (target.low[axis] - from[axis]) / direction[axis];
        const float b = (target.high[axis] - from[axis]) / direction[axis];
        if (std::min(a, b) > enter) {
            enter = std::min(a, b);
            normal = vec3(0);
            normal[axis] = direction[axis] > 0 ? -1.0F : 1.0F;
        }
        leave = std::min(leave, std::max(a, b));
    }
    if (enter >= leave || normal == vec3(0)) return {};
    return {enter, normal};
}

const vec2 middle = 0.5F * vec2(wide, tall);
vec2 center(std::uint32_t x, std::uint32_t y) { return {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}; }

/// The camera that the documentation describes.
struct Eye {
    vec3 target{0, 0.5F, 0}, position{1, 3, 6};
    float fov_degrees = 50;

    [[nodiscard]] static Eye orbiting(vec3 target, float distance, float yaw, float pitch, float fov_degrees = 50) {
        const float y = glm::radians(yaw), p = glm::radians(pitch);
        const vec3 away(std::cos(p) * std::sin(y), std::sin(p), std::cos(p) * std::cos(y));
        return {target, target + distance * away, fov_degrees};
    }
    [[nodiscard]] vec3 forward() const { return glm::normalize(target - position); }
    [[nodiscard]] vec3 right() const { return glm::normalize(glm::cross(forward(), vec3(0, 1, 0))); }
    [[nodiscard]] vec3 up() const { return glm::cross(right(), forward()); }
    /// Metres a pixel, at one metre.
    [[nodiscard]] float step() const { return 2 * std::tan(glm::radians(fov_degrees) / 2) / static_cast<float>(tall); }

    /// One metre of planar distance along the ray through a place of the picture, in pixels.
    [[nodiscard]] vec3 ray(vec2 pixel) const {
        return forward() + step() * (right() * (pixel.x - middle.x) + up() * (middle.y - pixel.y));
    }
    [[nodiscard]] vec2 pixel(vec3 point) const {
        const vec3 away = (point - position) / (step() * glm::dot(point - position, forward()));
        return middle + vec2(glm::dot(away, right()), -glm::dot(away, up()));
    }
    [[nodiscard]] Hit hit(vec2 pixel) const {
        const Hit of_box = trace(box, position, ray(pixel)), of_floor = trace(floor_box, position, ray(pixel));
        return of_box.distance < of_floor.distance ? of_box : of_floor;
    }
    /// What a pixel shows, unless an edge crosses it.
    [[nodiscard]] std::optional<Hit> inner(std::uint32_t x, std::uint32_t y, float margin = 0.55F) const {
        const Hit found = hit(center(x, y));
        for (const vec2& corner : {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)}) {
            const Hit beside = hit(center(x, y) + margin * corner);
            const bool is_same_box = beside.normal == found.normal && beside.is_sky() == found.is_sky() &&
                                     (found.is_sky() || std::abs(beside.distance / found.distance - 1) < 0.2F);
            if (!is_same_box) return std::nullopt;
        }
        return found;
    }
    /// Where the ray of a pixel meets a surface.
    [[nodiscard]] vec3 point(std::uint32_t x, std::uint32_t y, const Hit& hit) const {
        return position + hit.distance * ray(center(x, y));
    }
};

/// Whether the sun is hidden from a point by the box, made larger or smaller by a margin.
bool is_shaded(vec3 point, float margin) {
    const vec3 low = box.low - vec3(margin, 0, margin), high = box.high + margin;
    const bool is_inside = point.x > low.x && point.x < high.x && point.z > low.z && point.z < high.z;
    return is_inside || !trace({low, high}, point, toward_sun).is_sky();
}

void for_every_pixel(const std::function<void(std::uint32_t, std::uint32_t)>& check) {
    for (std::uint32_t y = 0; y < tall; ++y)
        for (std::uint32_t x = 0; x < wide; ++x) check(x, y);
}

class CliRenderPixels : public test::CliFixture {
  protected:
    void make_files() override { write("yard.scene.toml", yard); }
    [[nodiscard]] Picture rendered(std::vector<std::string> flags, const std::string& out = "out.png") const {
        for (const char* const smoothing : {"--samples", "--msaa"})
            if (!std::ranges::count(flags, smoothing)) flags.insert(flags.end(), {smoothing, "1"});
        flags.insert(flags.begin(), {"render", path("yard.scene.toml"), "-o", path(out), "--size", "96x64"});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture(out);
    }
};

/// The most different channel of a pixel of two pictures, in codes of 8 bits.
float codes_apart(const Picture& a, const Picture& b, std::uint32_t x, std::uint32_t y) {
    float worst = 0;
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.at(x, y)[c] - b.at(x, y)[c]));
    return worst * 255;
}

TEST_F(CliRenderPixels, TheGridLiesOnTheGroundBesideTheFloor) {
    const Picture with = rendered({}), without = rendered({"--no-grid"});
    const Eye eye;
    std::size_t lines = 0, ground = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        const std::optional<Hit> hit = eye.inner(x, y);
        if (!hit) return;
        const vec3 ray = eye.ray(center(x, y));
        const vec3 place = eye.position - ray * (eye.position.y / ray.y);
        const bool is_below = hit->is_sky() && ray.y < 0;
        const bool is_ground = is_below && std::abs(place.x) < 19 && std::abs(place.z) < 19;
        if (!is_below) {
            EXPECT_EQ(codes_apart(with, without, x, y), 0) << x << ", " << y;
        }
        if (!is_ground) return;
        ++ground;
        lines += codes_apart(with, without, x, y) > 0 ? 1 : 0;
    });
    EXPECT_GT(lines, ground / 8);
    EXPECT_LT(lines, ground);
}

TEST_F(CliRenderPixels, ShadowsDarkenWhatTheBoxHidesFromTheSun) {
    const Picture with = rendered({"--no-grid"}), without = rendered({"--no-grid", "--no-shadows"});
    const Picture coarse = rendered({"--no-grid", "--shadow-resolution", "256"});
    const Eye eye;
    std::size_t shaded = 0, coarser = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        const std::optional<Hit> hit = eye.inner(x, y);
        if (!hit) return;
        const vec3 point = hit->is_sky() ? vec3(0) : eye.point(x, y, *hit);
        // The box has no shadow on itself but that of its own faces, which shading knows of.
        const bool is_floor = !hit->is_sky() && point.y < 0.06F;
        // At its foot the filter takes the floor's texels in.
        if (!hit->is_sky() && !is_floor && point.y < 0.35F) return;
        if (!is_floor || !is_shaded(point, 0.06F)) {
            EXPECT_EQ(codes_apart(with, without, x, y), 0) << x << ", " << y;
        } else if (is_shaded(point, -0.06F)) {
            ++shaded;
            EXPECT_LT(with.at(x, y)[0], without.at(x, y)[0] - 0.1F) << x << ", " << y;
        }
        // Fewer texels move the edge alone.
        if (!is_floor || is_shaded(point, 0.35F) == is_shaded(point, -0.35F)) {
            EXPECT_EQ(codes_apart(with, coarse, x, y), 0) << x << ", " << y;
        }
        coarser += codes_apart(with, coarse, x, y) > 0 ? 1 : 0;
    });
    EXPECT_GT(shaded, 40U);
    EXPECT_GT(coarser, 5U);
}

class CliRenderSamples : public CliRenderPixels, public testing::WithParamInterface<const char*> {};

TEST_P(CliRenderSamples, SmoothEdgesAlone) {
    const Picture one = rendered({"--no-grid", "--no-shadows"});
    const Picture four = rendered({"--no-grid", "--no-shadows", GetParam(), "4"});
    const Eye eye;
    // At an edge a mean of what lies on its sides, which no pixel there was before.
    const auto is_between = [&](std::uint32_t x, std::uint32_t y) {
        float nearest = 255;
        for (std::uint32_t v = y - 1; v <= y + 1; ++v)
            for (std::uint32_t u = x - 1; u <= x + 1; ++u) {
                const float *const a = four.at(x, y), *const b = one.at(u, v);
                nearest = std::min(
                    nearest, 255 * std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])}));
            }
        return nearest > 3;
    };
    std::size_t smoothed = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        if (eye.inner(x, y)) {
            EXPECT_LE(codes_apart(one, four, x, y), 1.001F) << x << ", " << y;
        } else if (x > 0 && y > 0 && x + 1 < wide && y + 1 < tall && is_between(x, y)) {
            ++smoothed;
        }
    });
    EXPECT_GT(smoothed, 60U);
}

INSTANTIATE_TEST_SUITE_P(Ways, CliRenderSamples, testing::Values("--msaa", "--samples"));

TEST_F(CliRenderPixels, SamplesAreThoseOfTheFlagThenOfTheScene) {
    const auto picture_of = [&](std::string_view scene_samples, const char* flag) {
        std::string text = yard;
        if (!scene_samples.empty()) text.insert(text.find("[scene]") + 8, scene_samples);
        std::vector<std::string> words{"render", write("s.scene.toml", text), "-o", path("s.png"), "--size", "96x64"};
        if (flag != nullptr) words.insert(words.end(), {"--samples", flag});
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return content(path("s.png"));
    };
    const std::string usual = picture_of("", nullptr), one = picture_of("", "1"), seven = picture_of("", "7");
    EXPECT_TRUE(usual == picture_of("", "3"));
    EXPECT_FALSE(usual == one);
    EXPECT_EQ(picture_of("samples = 7\n", nullptr), seven);
    EXPECT_EQ(picture_of("samples = 7\n", "1"), one);
    const Outcome refused = run({"render", path("yard.scene.toml"), "--samples", "1025"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("--samples = 1025: allowed is [1, 1024]"), std::string::npos) << refused.err;
}

TEST_F(CliRenderPixels, ALensIsSampledAndNotBlurredAgain) {
    const std::vector<std::string> open{"--aperture", "0.5", "--sensor-height", "400", "--samples", "32"};
    const auto with = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), open.begin(), open.end());
        return flags;
    };
    const Picture pinhole = rendered({"--samples", "32"}), lens = rendered(with({})),
                  far = rendered(with({"--focus", "1000"}));
    double blurred = 0, far_off = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        blurred += double{codes_apart(pinhole, lens, x, y)};
        far_off += double{codes_apart(lens, far, x, y)};
    });
    EXPECT_GT(blurred, 2.0 * wide * tall);
    EXPECT_GT(far_off, 2.0 * wide * tall) << "without --focus it is the target's distance";
    std::vector<std::string> words{
        "render", path("yard.scene.toml"), "-o", path("twice.png"), "--size", "96x64", "--msaa", "1"};
    words.insert(words.end(), open.begin(), open.end());
    words.insert(words.end(), {"--depth-of-field-enabled", "on", "--depth-of-field-f-stop", "0.5"});
    const Outcome twice = run(words);
    EXPECT_EQ(twice.code, 0);
    EXPECT_NE(twice.told.find("--aperture: the lens blurs, depth_of_field is off"), std::string::npos) << twice.told;
    EXPECT_EQ(picture("twice.png"), lens);
    for (const auto& [flags, text] :
         {std::pair(std::vector<std::string>{"--focus", "3"}, "--focus: needs --aperture, which makes a lens"),
          {{"--aperture", "2", "--samples", "1"}, "--samples 1: with --aperture, allowed is [2, 1024]"},
          {{"--aperture", "0"}, "--aperture = 0: allowed is [0.5, 64]"},
          {{"--aperture", "2", "--no-postprocess"}, "--aperture: the scene's own shaders draw no blur"}}) {
        std::vector<std::string> all{"render", path("yard.scene.toml"), "-o", path("no.png"), "--size", "96x64"};
        all.insert(all.end(), flags.begin(), flags.end());
        const Outcome refused = run(all);
        EXPECT_EQ(refused.code, 1);
        EXPECT_NE(refused.err.find(text), std::string::npos) << refused.err;
    }
}

// What [camera] says of its lens makes the same pictures as the flags that say so.
TEST_F(CliRenderPixels, TheScenesCameraSaysItsLens) {
    std::string text = yard;
    text.insert(text.find("fov = 50"), "aperture = 0.5\nfocus = 3\nsensor_height = 400\n");
    const auto drawn = [&](const std::string& scene, std::vector<std::string> flags) {
        const std::string file = write("lens.scene.toml", scene);
        flags.insert(flags.begin(), {"render", file, "-o", path("lens.png"), "--size", "96x64", "--samples", "4"});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return content(path("lens.png"));
    };
    const auto with = [](std::vector<std::string> flags, const std::vector<std::string>& more) {
        flags.insert(flags.end(), more.begin(), more.end());
        return flags;
    };
    const std::vector<std::string> on{"--depth-of-field-enabled", "on"};
    EXPECT_TRUE(drawn(text, {}) == drawn(yard, {})) << "by itself it blurs nothing";
    const std::string blurred = drawn(text, on);
    EXPECT_FALSE(blurred == drawn(yard, on));
    EXPECT_TRUE(blurred == drawn(yard, with(on, {"--depth-of-field-f-stop", "0.5", "--depth-of-field-focus-distance",
                                                 "3", "--depth-of-field-sensor-height", "400"})));
    const std::vector<std::string> look =
        with(on, {"--look", write("plain.toml", "[post_process]\nexposure = 0.25\n")});
    EXPECT_TRUE(drawn(text, look) ==
                drawn(yard, with(look, {"--depth-of-field-f-stop", "0.5", "--depth-of-field-focus-distance", "3",
                                        "--depth-of-field-sensor-height", "400"})))
        << "the look of another file";
    const std::vector<std::string> farther = with(on, {"--depth-of-field-focus-distance", "9"});
    EXPECT_FALSE(drawn(text, farther) == blurred) << "a flag goes first";

    const std::vector<std::string> open{"--aperture", "0.5"};
    const std::string seen = drawn(text, open);
    EXPECT_TRUE(seen == drawn(yard, with(open, {"--focus", "3", "--sensor-height", "400"})));
    EXPECT_FALSE(seen == drawn(text, with(open, {"--focus", "9"})));
    EXPECT_FALSE(seen == drawn(text, with(open, {"--sensor-height", "40"})));
}

TEST_F(CliRenderPixels, TheOverlayIsTheEdgesOfTriangles) {
    const Picture plain = rendered({"--no-grid"}), lines = rendered({"--no-grid", "--wireframe-overlay"});
    const Eye eye;
    std::size_t edges = 0, drawn = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        const bool is_drawn = codes_apart(plain, lines, x, y) > 0;
        const std::optional<Hit> hit = eye.inner(x, y, 1.5F);
        if (hit && hit->is_sky()) {
            EXPECT_FALSE(is_drawn) << x << ", " << y;
        }
        if (!eye.inner(x, y)) {
            ++edges;
            drawn += is_drawn ? 1 : 0;
        }
        if (!hit || hit->is_sky()) return;
        // Within a face its diagonals, one of which is drawn.
        const vec3 point = eye.point(x, y, *hit);
        const scene::Box& of = point.y < 0.06F ? floor_box : box;
        const vec3 across = (point - of.low) / (of.high - of.low);
        const int axis = hit->normal.x != 0 ? 0 : hit->normal.y != 0 ? 1 : 2;
        const float u = across[(axis + 1) % 3], v = across[(axis + 2) % 3];
        if (std::min(std::abs(u - v), std::abs(u + v - 1)) > 0.12F) {
            EXPECT_FALSE(is_drawn) << x << ", " << y;
        }
    });
    EXPECT_GT(drawn, edges / 2);
}

TEST_F(CliRenderPixels, ArrowsStandOnTheCorners) {
    const Picture plain = rendered({"--no-grid"}), arrows = rendered({"--no-grid", "--show-normals"});
    // From each corner along each of its three normals, of 0.05 halves of the picture's height at its distance.
    const Eye eye;
    std::vector<std::pair<vec2, vec2>> segments;
    for (const scene::Box& of : {floor_box, box})
        for (int corner = 0; corner < 8; ++corner)
            for (int axis = 0; axis < 3; ++axis) {
                vec3 at = of.low, normal(0);
                for (int i = 0; i < 3; ++i)
                    if ((corner >> i & 1) != 0) at[i] = of.high[i];
                normal[axis] = (corner >> axis & 1) != 0 ? 1.0F : -1.0F;
                const float length_m = 0.05F * middle.y * eye.step() * glm::dot(at - eye.position, eye.forward());
                segments.emplace_back(eye.pixel(at), eye.pixel(at + normal * length_m));
            }
    std::size_t drawn = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        if (codes_apart(plain, arrows, x, y) == 0) return;
        ++drawn;
        float nearest = 1e9F;
        for (const auto& [from, to] : segments) {
            const vec2 way = to - from;
            const float along = std::clamp(glm::dot(center(x, y) - from, way) / glm::dot(way, way), 0.0F, 1.0F);
            nearest = std::min(nearest, glm::distance(center(x, y), from + along * way));
        }
        EXPECT_LE(nearest, 1.0F) << x << ", " << y;
    });
    EXPECT_GT(drawn, 20U);
}

double encoded(double light) {
    const double x = std::clamp(light, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}
double narkowicz(double x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

TEST_F(CliRenderPixels, CurvesAreThoseOfTheLight) {
    const Picture tonemapped = rendered({"--no-grid", "--frame", path("f.exr")});
    const Picture linear = rendered({"--no-grid", "--no-tonemapping"});
    const Picture off = rendered({"--no-grid", "--no-postprocess"});
    const Picture both_off = rendered({"--no-grid", "--no-postprocess", "--no-tonemapping"});
    const Result<FrameFile> frame = read_frame(path("f.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    double brightest = 0;
    for_every_pixel([&](std::uint32_t x, std::uint32_t y) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double light = frame->color.at(x, y)[c];
            brightest = std::max(brightest, light);
            EXPECT_NEAR(tonemapped.at(x, y)[c], encoded(narkowicz(0.25 * light)), 1.0 / 255) << x << ", " << y;
            EXPECT_NEAR(linear.at(x, y)[c], encoded(0.25 * light), 1.0 / 255) << x << ", " << y;
            EXPECT_NEAR(off.at(x, y)[c], encoded(narkowicz(0.25 * light)), 2.0 / 255) << x << ", " << y;
            EXPECT_NEAR(both_off.at(x, y)[c], encoded(0.25 * light), 2.0 / 255) << x << ", " << y;
        }
    });
    EXPECT_GT(brightest, 1) << "light that a display cuts off";
}

TEST_F(CliRenderPixels, CamerasSeeWhatTheirRaysMeet) {
    const vec3 target(0, 0.5F, 0), offset(1, 2.5F, 6);
    const float distance = glm::length(offset), yaw = glm::degrees(std::atan2(1.0F, 6.0F)),
                pitch = glm::degrees(std::asin(2.5F / glm::length(offset)));
    const std::vector<std::pair<std::vector<std::string>, Eye>> cases{
        {{}, Eye{}},
        {{"--distance", "9"}, Eye::orbiting(target, 9, yaw, pitch)},
        {{"--yaw", "120"}, Eye::orbiting(target, distance, 120, pitch)},
        {{"--pitch", "70"}, Eye::orbiting(target, distance, yaw, 70)},
        {{"--target", "1, 0.5, 0"}, Eye::orbiting({1, 0.5F, 0}, distance, yaw, pitch)},
        {{"--target=-1,0,2"}, Eye::orbiting({-1, 0, 2}, distance, yaw, pitch)},
        {{"--fov", "80"}, Eye::orbiting(target, distance, yaw, pitch, 80)}};
    for (const auto& [flags, eye] : cases) {
        std::vector<std::string> arguments = flags;
        arguments.insert(arguments.end(), {"--no-shadows", "--frame", path("f.exr")});
        static_cast<void>(rendered(arguments));
        SCOPED_TRACE(flags.empty() ? "no flag" : flags[0]);
        const Result<FrameFile> frame = read_frame(path("f.exr"));
        ASSERT_TRUE(frame && frame->depth && frame->normals);
        std::size_t boxes = 0;
        for_every_pixel([&, &eye = eye](std::uint32_t x, std::uint32_t y) {
            const std::optional<Hit> hit = eye.inner(x, y);
            if (!hit) return;
            const float found = *frame->depth->at(x, y);
            EXPECT_EQ(found >= sky_depth, hit->is_sky()) << x << ", " << y;
            if (hit->is_sky() || found >= sky_depth) return;
            boxes += hit->normal.y == 0 ? 1 : 0;
            EXPECT_NEAR(found / hit->distance, 1, 1e-4F) << x << ", " << y;
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(frame->normals->at(x, y)[axis], hit->normal[axis], 1e-3F) << x << ", " << y;
        });
        EXPECT_GT(boxes, 20U);
    }
}

}  // namespace
}  // namespace darkroom
