// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/look.hpp>

namespace darkroom {

namespace {

constexpr auto entry_description =
    describe(field<&EntryState::enabled>("Is the effect applied."),
             field<&EntryState::opacity>("How much of the result goes over the input.", {0, 1}),
             field<&EntryState::blend>("How the result goes over the input."),
             field<&EntryState::scale>("Sides of its output, relative to its input's: the nearest fraction of two "
                                       "numbers up to 64.",
                                       {0.015625, 4}),
             field<&EntryState::format>("Of the image that its output becomes."));

constexpr auto pulse_description =
    describe(field<&PulseState::envelope>("How it dies down."),
             field<&PulseState::duration>("How long it lasts.", {0.001, 3600}, unit::seconds));

constexpr auto layer_description = describe(field<&LayerState::weight>("How much of it goes over the base.", {0, 1}));

constexpr auto distance_description =
    describe(field<&LayerDistance::near>("Where it has its whole weight, and nearer.", {0, 1e6}, unit::metres),
             field<&LayerDistance::far>("Where it has none, and farther.", {0, 1e6}, unit::metres),
             field<&LayerDistance::point>("Of the world, that distances are from.", {-1e6, 1e6}, unit::metres));

}  // namespace

constinit const ParamTable entry_rows = entry_description.table();
constinit const ParamTable pulse_rows = pulse_description.table();
constinit const ParamTable layer_rows = layer_description.table();
constinit const ParamTable distance_rows = distance_description.table();

}  // namespace darkroom
