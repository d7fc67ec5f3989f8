// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/look.hpp>

namespace darkroom {

namespace {

constexpr auto entry_description =
    describe(field<&EntryState::enabled>("Applies the effect."),
             field<&EntryState::opacity>("Share of the result that goes over the input.", {0, 1}),
             field<&EntryState::blend>("Formula that lays the result over the input."),
             field<&EntryState::scale>(
                 "Side lengths of the output relative to the input's, as the nearest fraction of two numbers up to 64.",
                 {0.015625, 4}),
             field<&EntryState::format>("Format of the image that holds the output."));

constexpr auto pulse_description =
    describe(field<&PulseState::envelope>("Shape of the decay."),
             field<&PulseState::duration>("Time that the pulse lasts.", {0.001, 3600}, unit::seconds));

constexpr auto layer_description =
    describe(field<&LayerState::weight>("Share of the layer that goes over the base.", {0, 1}));

constexpr auto distance_description = describe(
    field<&LayerDistance::near>("Distance up to which the layer has its whole weight.", {0, 1e6}, unit::metres),
    field<&LayerDistance::far>("Distance from which the layer has no weight.", {0, 1e6}, unit::metres),
    field<&LayerDistance::point>("Point of the world that distances are measured from.", {-1e6, 1e6}, unit::metres));

}  // namespace

constinit const ParamTable entry_rows = entry_description.table();
constinit const ParamTable pulse_rows = pulse_description.table();
constinit const ParamTable layer_rows = layer_description.table();
constinit const ParamTable distance_rows = distance_description.table();

}  // namespace darkroom
