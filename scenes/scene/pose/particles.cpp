// SPDX-License-Identifier: MIT
#include "scene/pose/particles.hpp"

#include <cmath>
#include <queue>

#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

/// Counter-based random numbers: number i of particle n is a hash of seed, n and i. Steele, Lea and Flood, "Fast
/// Splittable Pseudorandom Number Generators", 2014, the finaliser of SplitMix64.
std::uint64_t mixed(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9;
    value = (value ^ (value >> 27)) * 0x94d049bb133111eb;
    return value ^ (value >> 31);
}

enum class Draw : std::uint64_t { Lifetime, Speed, Tilt, Azimuth, First, Second, Third };
enum class Stream : std::uint64_t { Steady, Burst };

class Randomness {
  public:
    Randomness(std::uint64_t seed, Stream stream, std::uint64_t number)
        : state_(mixed(mixed(seed + static_cast<std::uint64_t>(stream)) ^ number)) {}
    /// In [0, 1).
    [[nodiscard]] double operator()(Draw draw) const {
        return static_cast<double>(mixed(state_ + static_cast<std::uint64_t>(draw)) >> 11) * 0x1p-53;
    }

  private:
    std::uint64_t state_;
};

struct Birth {
    double time = 0, lifetime = 0;
    Randomness random;
};

double between(float low, float high, double fraction) {
    return static_cast<double>(low) + (static_cast<double>(high) - static_cast<double>(low)) * fraction;
}

/// The births of an emitter in order of time, of which those are skipped that meet max_particles living ones. Steady
/// birth k, from 1, is at k / emission_rate; a burst comes first at the start of a cycle.
class History {
  public:
    History(const ParticleEmitter& emitter, std::uint64_t seed, double time)
        : emitter_(emitter),
          seed_(seed),
          time_(time),
          rate_(std::max(0.0, static_cast<double>(emitter.emission_rate))),
          cycle_(std::max(0.0, static_cast<double>(emitter.duration))),
          shortest_life_(std::max(0.0F, std::min(emitter.lifetime_min, emitter.lifetime_max))),
          longest_life_(std::max({0.0F, emitter.lifetime_min, emitter.lifetime_max})),
          max_alive_(std::min(emitter.max_particles, max_particles)),
          is_repeating_(emitter.is_looping && cycle_ > 0),
          end_(cycle_ > 0 && !emitter.is_looping ? std::min(time, cycle_) : time) {}

    /// Those alive at the time.
    [[nodiscard]] std::vector<Birth> living() {
        const double start = first_time();
        next_steady_ = std::max(1.0, std::ceil(start * rate_));
        next_burst_ = is_repeating_ ? std::ceil(start / cycle_) : 0;
        const bool has_first_burst = start <= 0 || is_repeating_;
        // The bound is reached only where events are too close together for a double to tell apart.
        for (; events_ < 2 * max_births; ++events_) {
            const double steady = rate_ > 0 ? next_steady_ / rate_ : never;
            const double burst = emitter_.burst_count > 0 && has_first_burst ? burst_time() : never;
            const double now = std::min(steady, burst);
            if (!(now <= end_)) break;
            while (!deaths_.empty() && deaths_.top() <= now) deaths_.pop();
            if (is_full())
                skip_to(deaths_.top(), burst <= steady);
            else if (burst <= steady)
                bear_burst(burst);
            else
                bear(steady, Stream::Steady, next_steady_++);
        }
        return std::move(born_);
    }

  private:
    static constexpr double never = std::numeric_limits<double>::infinity();
    /// Births that are looked at for one picture, where what was skipped before bears on what is alive now. It is
    /// about 10 ms of work; an emitter that has seen more starts its history anew.
    static constexpr std::uint32_t max_births = 262144;

    [[nodiscard]] double first_time() const {
        const double bursts = is_repeating_ ? std::floor(longest_life_ / cycle_) + 1 : 1;
        const double wanted = rate_ * longest_life_ + 1 + bursts * emitter_.burst_count;
        // No birth was ever skipped, so those that died already do not matter. The margin is for rounding.
        if (wanted + 1 <= max_alive_) return std::max(0.0, time_ - longest_life_ - 1e-6 * (1 + time_));
        // Within the shortest life nobody dies, so no more than `max_alive_` are born.
        const double offered = rate_ + (is_repeating_ ? max_alive_ / cycle_ : 0);
        const double accepted = shortest_life_ > 0 ? std::min(offered, max_alive_ / shortest_life_) : offered;
        const double stretch = (max_births - max_alive_) * 0.5 / std::clamp(accepted, 1e-9, 1e12);
        return std::max(0.0, (std::floor(end_ / stretch) - 1) * stretch);
    }

    [[nodiscard]] double burst_time() const {
        if (next_burst_ == 0) return 0;
        return is_repeating_ ? next_burst_ * cycle_ : never;
    }

    [[nodiscard]] bool is_full() const { return deaths_.size() >= max_alive_; }

    /// Nothing is born before the first death; at least one birth is passed over, whatever rounding says.
    void skip_to(double death, bool is_burst_next) {
        next_steady_ = std::max(next_steady_ + (is_burst_next ? 0 : 1), std::ceil(death * rate_));
        const double later = is_repeating_ ? std::ceil(death / cycle_) : 1;
        next_burst_ = std::max(next_burst_ + (is_burst_next ? 1 : 0), later);
    }

    void bear_burst(double time) {
        const double first = next_burst_++ * emitter_.burst_count;
        const std::uint32_t count = std::min(emitter_.burst_count, max_alive_);
        for (std::uint32_t i = 0; i < count && !is_full(); ++i) bear(time, Stream::Burst, first + i);
    }

    void bear(double time, Stream stream, double number) {
        ++events_;
        const Randomness random(seed_, stream, static_cast<std::uint64_t>(number));
        const double lifetime = shortest_life_ + (longest_life_ - shortest_life_) * random(Draw::Lifetime);
        if (!(lifetime > 0)) return;
        deaths_.push(time + lifetime);
        if (time + lifetime > time_) born_.push_back({time, lifetime, random});
    }

    const ParticleEmitter& emitter_;
    std::uint64_t seed_;
    double time_, rate_, cycle_, shortest_life_, longest_life_;
    std::uint32_t max_alive_;
    bool is_repeating_;
    double end_;  // of emission
    double next_steady_ = 1, next_burst_ = 0;
    std::uint32_t events_ = 0;
    std::priority_queue<double, std::vector<double>, std::greater<>> deaths_;
    std::vector<Birth> born_;
};

/// A vector at `tilt` from the axis.
vec3 tilted(vec3 axis, double tilt, double azimuth) {
    const vec3 helper = std::abs(axis.x) < 0.7F ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 side = glm::normalize(glm::cross(helper, axis));
    const vec3 other = glm::cross(axis, side);
    const double level = std::sin(tilt);
    return axis * static_cast<float>(std::cos(tilt)) + side * static_cast<float>(level * std::cos(azimuth)) +
           other * static_cast<float>(level * std::sin(azimuth));
}

/// How a particle starts, relative to its emitter.
struct Start {
    vec3 offset{0};
    vec3 velocity{0};
};

Start start_of(const ParticleEmitter& emitter, const Randomness& random) {
    constexpr double turn = glm::two_pi<double>();
    const double u = random(Draw::First), v = random(Draw::Second), w = random(Draw::Third);
    const float radius = emitter.shape_radius;
    vec3 axis = turned(mat4(1), emitter.direction, vec3(0, 1, 0));
    Start out;
    switch (emitter.shape) {
        case EmitterShape::Point:
            break;
        case EmitterShape::Sphere:  // uniform in the volume
            out.offset =
                tilted(vec3(0, 1, 0), std::acos(1 - 2 * u), turn * v) * (radius * static_cast<float>(std::cbrt(w)));
            break;
        case EmitterShape::Cone: {  // from a disc, the further out the more outward
            const double part = std::sqrt(u);
            out.offset = tilted(axis, glm::half_pi<double>(), turn * v) * (radius * static_cast<float>(part));
            axis = tilted(axis, glm::radians(static_cast<double>(emitter.shape_angle)) * part, turn * v);
            break;
        }
        case EmitterShape::Box:
            out.offset = emitter.shape_extents * vec3(static_cast<float>(2 * u - 1), static_cast<float>(2 * v - 1),
                                                      static_cast<float>(2 * w - 1));
            break;
    }
    // Uniform on the cap of half angle `spread`: its height is, after Archimedes.
    const double spread = glm::radians(std::clamp(static_cast<double>(emitter.spread), 0.0, 180.0));
    const double height = 1 - random(Draw::Tilt) * (1 - std::cos(spread));
    const double speed = between(emitter.speed_min, emitter.speed_max, random(Draw::Speed));
    out.velocity = tilted(axis, std::acos(std::clamp(height, -1.0, 1.0)), turn * random(Draw::Azimuth)) *
                   static_cast<float>(speed);
    return out;
}

/// The solution of v' = gravity - damping * v: position = start + velocity * drift + gravity * fall.
struct Motion {
    double drift = 0, fall = 0;
    Motion(double damping, double age) {
        const double x = damping * age;
        if (std::abs(x) < 1e-3) {  // series, where the closed form subtracts equal numbers
            drift = age * (1 - x / 2 + x * x / 6);
            fall = age * age * (0.5 - x / 6 + x * x / 24);
            return;
        }
        drift = -std::expm1(-x) / damping;
        fall = (age - drift) / damping;
    }
};

vec3 position_at(const ParticleEmitter& emitter, const Start& start, const mat4& world, double age) {
    const Motion motion(static_cast<double>(emitter.damping), age);
    const float speed = glm::length(start.velocity);
    const vec3 velocity = speed > 0 ? turned(world, start.velocity, vec3(0)) * speed : vec3(0);
    return vec3(world * vec4(start.offset, 1)) + velocity * static_cast<float>(motion.drift) +
           emitter.gravity * static_cast<float>(motion.fall);
}

vec4 frame_at(const ParticleEmitter& emitter, double fraction) {
    const std::uint64_t columns = std::max(emitter.frames_x, 1U), rows = std::max(emitter.frames_y, 1U);
    const auto count = columns * rows;
    const auto reached = static_cast<std::uint64_t>(fraction * static_cast<double>(count));
    const std::uint64_t frame = emitter.animates_frames ? std::min(reached, count - 1) : 0;
    const vec2 size(1.0F / static_cast<float>(columns), 1.0F / static_cast<float>(rows));
    const vec2 corner = size * vec2(static_cast<float>(frame % columns), static_cast<float>(frame / columns));
    return {corner, corner + size};
}

}  // namespace

std::vector<Particle> particles(const ParticleEmitter& emitter, const EmitterPath& path, std::uint64_t seed,
                                double time, double previous_time) {
    const bool is_emitting = emitter.is_playing || emitter.autoplay;
    if (!is_emitting || emitter.max_particles == 0 || !(time >= 0) || std::isinf(time)) return {};
    const std::vector<Birth> births = History(emitter, seed, time).living();
    std::vector<Particle> out;
    out.reserve(births.size());
    const mat4 world_now = path(time), world_then = path(previous_time);
    for (const Birth& birth : births) {
        const Start start = start_of(emitter, birth.random);
        const mat4 world_at_birth = emitter.is_world_space ? path(birth.time) : mat4(1);
        const double age = time - birth.time;
        const double fraction = std::clamp(age / birth.lifetime, 0.0, 1.0);
        Particle particle{
            .size = static_cast<float>(between(emitter.size_start, emitter.size_end, fraction)),
            .color = glm::mix(emitter.color_start, emitter.color_end, static_cast<float>(fraction)),
            .uv = frame_at(emitter, fraction),
        };
        particle.position = position_at(emitter, start, emitter.is_world_space ? world_at_birth : world_now, age);
        const double previous_age = previous_time - birth.time;
        const bool was_alive = previous_age >= 0 && previous_age < birth.lifetime;
        particle.previous_position =
            was_alive ? position_at(emitter, start, emitter.is_world_space ? world_at_birth : world_then, previous_age)
                      : particle.position;
        out.push_back(particle);
    }
    return out;
}

}  // namespace darkroom::scene
