// SPDX-License-Identifier: MIT
#pragma once
// The pulses and layers of a look in a Composer that follows it.

#include <darkroom/look.hpp>

namespace darkroom {

class ModulationFollower {
  public:
    /// Remembers what the Composer has of a look, before its stack changes.
    ModulationFollower(const Look& was, Composer& composer);
    /// Gives the changed stack the pulses and layers of another look. What stays as it is goes on as it runs. Did
    /// anything change?
    [[nodiscard]] Result<bool> follow(const Look& is);

  private:
    struct Descs {
        std::vector<PulseDesc> pulses;
        std::vector<LayerDesc> layers;
        std::vector<const EffectInfo*> effects;  ///< of the entries that they move: another one's rows are others
    };
    [[nodiscard]] Descs descs_of(const Look& look) const;

    Composer& composer_;
    Descs was_;
};

}  // namespace darkroom
