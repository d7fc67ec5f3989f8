// SPDX-License-Identifier: MIT
#pragma once
// The scene of samples/window.exr: a hall of columns with a tall, barred window, bright sky outside, lamps inside. It
// is ray-cast on the CPU from shapes alone. It is a picture to try effects on, not a physically exact one. Metres, y
// up, right-handed; the camera looks along its own -z.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace darkroom::samples {

struct Vec3 {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;

    [[nodiscard]] bool operator==(const Vec3&) const = default;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 operator*(Vec3 a, float b) { return {a.x * b, a.y * b, a.z * b}; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 normalize(Vec3 a) { return a * (1.0f / std::sqrt(dot(a, a))); }
inline Vec3 mix(Vec3 a, Vec3 b, float t) { return a + (b - a) * t; }

/// A camera that may look up or down but neither sideways nor tilted.
struct Camera {
    Vec3 position;
    float pitch_rad = 0.0f;
    float vertical_fov_rad = 0.7f;
    float aspect = 16.0f / 9.0f;

    [[nodiscard]] Vec3 to_view(Vec3 world) const;
    /// The unnormalised direction, of planar length 1, through a place of the picture; (0, 0) is its upper left corner.
    [[nodiscard]] Vec3 ray(float u, float v) const;
    /// Where a point of view space appears in the picture, 0 to 1, v down.
    [[nodiscard]] std::array<float, 2> project(Vec3 view) const;
};

/// What the ray through the centre of a pixel meets.
struct Surface {
    bool is_sky = true;
    Vec3 position;
    Vec3 previous_position;  ///< of the same place of the object, one frame before
    Vec3 normal;
};

class Room {
  public:
    /// Samples of one pixel are numbered; each uses its own point of every area light, the same in all pixels.
    static constexpr std::uint32_t samples = 16;

    Room();
    [[nodiscard]] Vec3 radiance(Vec3 origin, Vec3 direction, std::uint32_t sample) const;
    [[nodiscard]] Surface surface(Vec3 origin, Vec3 direction) const;

  private:
    enum class Kind { Box, Sphere, Cylinder };
    struct Material {
        Vec3 albedo;
        Vec3 emission;
        float reflectance = 0.0f;  ///< at normal incidence
        bool is_metal = false;
        int texture = 0;  ///< 0 none, 1 floor tiles, 2 wood, 3 plaster
    };
    struct Shape {
        Kind kind = Kind::Box;
        Vec3 low;   ///< corner of a box; centre of a sphere; foot of a cylinder
        Vec3 high;  ///< corner of a box; radius, height and nothing of the others
        Material material;
        Vec3 motion;  ///< since the frame before
    };
    struct Hit {
        float distance = 0.0f;
        const Shape* shape = nullptr;
    };

    struct Ray {
        Vec3 origin;
        Vec3 direction;
        Vec3 inverse;

        Ray(Vec3 from, Vec3 along)
            : origin(from), direction(along), inverse{1.0f / along.x, 1.0f / along.y, 1.0f / along.z} {}
    };
    /// Shapes close to each other, tested only if the ray meets the box around them.
    struct Group {
        Vec3 low;
        Vec3 high;
        std::size_t first = 0;
        std::size_t end = 0;
    };

    void box(Vec3 low, Vec3 high, const Material& material);
    void sphere(Vec3 centre, float radius, const Material& material, Vec3 motion = {});
    void cylinder(Vec3 foot, float radius, float height, const Material& material);
    void build_shell();
    void build_furniture();
    void build_outside();

    void begin_group() { groups_.push_back({.first = shapes_.size()}); }
    void close_groups();

    static float intersect(const Shape& shape, const Ray& ray, float nearest);
    void trace(Hit& hit, const Ray& ray, std::size_t first_group, std::size_t end_group) const;
    [[nodiscard]] Hit trace(const Ray& ray) const;
    [[nodiscard]] bool is_free(Vec3 from, Vec3 to, std::size_t first_group, std::size_t end_group) const;
    [[nodiscard]] bool sees_sun(Vec3 from, Vec3 direction) const;
    static Vec3 normal_of(const Shape& shape, Vec3 position);
    static Vec3 sky(Vec3 direction);
    static Vec3 textured(const Material& material, Vec3 position);
    [[nodiscard]] Vec3 direct_light(Vec3 position, Vec3 normal, std::uint32_t sample) const;
    [[nodiscard]] Vec3 radiance(Vec3 origin, Vec3 direction, std::uint32_t sample, int bounces) const;

    std::vector<Shape> shapes_;
    std::vector<Group> groups_;  ///< first the shell of the room, then what is in it, then what is outside
    std::size_t outside_ = 0;    ///< the first group outside
};

}  // namespace darkroom::samples
