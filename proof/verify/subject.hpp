// SPDX-License-Identifier: MIT
#pragma once
// What is verified: stacks that between them run every kernel of this build. An effect alone with its defaults, with
// each other value of a choice or toggle, and with random values; and the chains of both shipped orders.

#include <cstdint>
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>
#include <string>
#include <vector>

#include "verify/scene.hpp"

namespace darkroom::verify {

struct Step {
    const EffectInfo* info = nullptr;
    std::vector<std::uint32_t> words;  ///< of its parameters; resources are replaced by those of fill()
};

struct Subject {
    std::string name;  ///< "ssao", "ssao[method=hemisphere]", "ssao[random 2]", "documented"
    std::vector<Step> steps;
};

struct SubjectOptions {
    std::vector<std::string> effects;  ///< names; empty: all, and the chains
    bool has_choices = true;
    std::uint32_t random_sets = 2;  ///< of each effect
    std::uint32_t seed = 1;
};

/// Is the picture larger than the frame where its target is?
[[nodiscard]] bool makes_output(const Subject& subject);
/// May a kernel of it read between texels?
[[nodiscard]] bool filters(const Subject& subject);

/// Those that tell most for their time first: each effect once, the chains, choices, random values.
[[nodiscard]] std::vector<Subject> subjects(const SubjectOptions& options = {});

/// Does an effect of it read between the texels of a table of its own that has 8 bits?
[[nodiscard]] bool filters_byte_tables(const Subject& subject);
/// Does it read its picture at places that it works out?
[[nodiscard]] bool is_map(const Subject& subject);
/// Does a kernel of it work out transfer functions by polynomials?
[[nodiscard]] bool has_curves(const Subject& subject);

/// What parameters name, so that an effect that does nothing without it is tried, too.
struct Brought {
    ColorTable table;       ///< a cube of four entries a side
    ResourceImage picture;  ///< of 7x5 pixels, from 0 to 1

    Brought();
    /// Numbers moved by `by`; those of the picture by a code of 8 bits besides, in which an effect may keep it.
    [[nodiscard]] Brought disturbed(std::mt19937& random, const Disturbance& by) const;
};

/// Appends the steps, each behind the one before, second pictures being the scene's alpha.
[[nodiscard]] Result<> fill(const Subject& subject, Composer& composer, const Brought& brought = {});

/// Does the effect change anything with these values?
[[nodiscard]] bool is_seen(const EffectInfo& info, std::span<const std::uint32_t> words);

}  // namespace darkroom::verify
