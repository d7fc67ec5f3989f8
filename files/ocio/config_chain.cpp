// SPDX-License-Identifier: MIT
#include "ocio/config_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/primaries.hpp"
#include "core/text/param_text.hpp"
#include "ocio/ocio_support.hpp"

namespace darkroom {
namespace {

using Names = std::vector<std::string>;

class ConfigChain final : public ColorChain {
  public:
    ConfigChain(const ocio::ConstConfigRcPtr& config, const ocio::ConstTransformRcPtr& transform)
        : processor_(config->getProcessor(transform)) {}

    void apply(std::span<std::array<float, 3>> colors) const override { run(processor_, colors); }
    Result<ColorTable> sampled() const override {
        return user_error("a color space of a configuration cannot be written as a table");
    }

  private:
    ocio::ConstProcessorRcPtr processor_;
};

/// A space of the configuration whose light is known here.
struct Link {
    std::string name;
    Chromaticities primaries;
};

// Configurations that name no interchange space have one of these names, or aliases, for it.
std::optional<Link> link_of(const ocio::ConstConfigRcPtr& config) {
    constexpr Chromaticities ap0{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, {0.32168, 0.33767}};
    for (const char* const name : {"aces_interchange", "ACES2065-1", "aces2065_1", "aces2065", "ACES - ACES2065-1"})
        if (config->getColorSpace(name)) return Link{name, ap0};
    for (const char* const name : {"lin_rec709", "lin_rec709_srgb", "lin_srgb", "lin709", "Linear Rec.709 (sRGB)",
                                   "Utility - Linear - sRGB", "Utility - Linear - Rec.709"})
        if (config->getColorSpace(name)) return Link{name, {}};
    return std::nullopt;
}

ocio::MatrixTransformRcPtr transform_of(const ColorMatrix& m) {
    const std::array<double, 16> rows{m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0, 0, 0, 0, 1};
    const ocio::MatrixTransformRcPtr out = ocio::MatrixTransform::Create();
    out->setMatrix(rows.data());
    return out;
}

struct Opened {
    ocio::ConstConfigRcPtr config;
    Link link;
};

Result<Opened> open_config(const std::filesystem::path& path) {
    ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(path.c_str());
    const std::optional<Link> link = link_of(config);
    if (!link) return user_error("no space in it is known: the role aces_interchange is needed, or a space lin_rec709");
    return Opened{config, *link};
}

/// Those that `name_of` gives, up to a thousand.
template <class NameOf>
Names names_of(int count, const NameOf& name_of) {
    Names out;
    for (int i = 0; i < std::min(count, 1000); ++i) out.emplace_back(name_of(i));
    return out;
}

Failure unknown(std::string_view what, const std::string& name, const Names& names) {
    return user_error(fmt::format("has no {} '{}'{}", what, printable(name), alternatives(name, names, "there are")));
}

/// To linear Rec. 709.
Result<ocio::GroupTransformRcPtr> transform_from(const Opened& opened, const std::string& space) {
    const auto& [config, link] = opened;
    if (!config->getColorSpace(space.c_str()))
        return unknown("color space", space, names_of(config->getNumColorSpaces(), [&](int i) {
                           return config->getColorSpaceNameByIndex(i);
                       }));
    const ocio::ColorSpaceTransformRcPtr to_link = ocio::ColorSpaceTransform::Create();
    to_link->setSrc(space.c_str());
    to_link->setDst(link.name.c_str());
    ocio::GroupTransformRcPtr all = ocio::GroupTransform::Create();
    all->appendTransform(to_link);
    all->appendTransform(transform_of(*conversion(link.primaries, {})));
    return all;
}

template <class Make>
Result<std::unique_ptr<ColorChain>> guarded(const std::filesystem::path& configuration, const Make& make) {
    try {
        return make();
    } catch (const std::exception& exception) {
        return failure(error_of(exception, configuration));
    }
}

}  // namespace

Result<std::unique_ptr<ColorChain>> chain_from_space(const std::filesystem::path& configuration,
                                                     const std::string& space) {
    return guarded(configuration, [&]() -> Result<std::unique_ptr<ColorChain>> {
        DARKROOM_TRY_VALUE(const Opened opened, open_config(configuration));
        DARKROOM_TRY_VALUE(const ocio::GroupTransformRcPtr all, transform_from(opened, space));
        return std::make_unique<ConfigChain>(opened.config, all);
    });
}

Result<std::unique_ptr<ColorChain>> chain_to_view(const std::filesystem::path& configuration,
                                                  const std::string& display, const std::string& view,
                                                  const std::string& space) {
    return guarded(configuration, [&]() -> Result<std::unique_ptr<ColorChain>> {
        DARKROOM_TRY_VALUE(const Opened opened, open_config(configuration));
        const ocio::ConstConfigRcPtr& config = opened.config;
        const Link& link = opened.link;
        const Names displays = names_of(config->getNumDisplays(), [&](int i) { return config->getDisplay(i); });
        if (std::ranges::find(displays, display) == displays.end()) return unknown("display", display, displays);
        const Names views =
            names_of(config->getNumViews(display.c_str()), [&](int i) { return config->getView(display.c_str(), i); });
        const std::string chosen = view.empty() ? std::string(config->getDefaultView(display.c_str())) : view;
        if (std::ranges::find(views, chosen) == views.end()) return unknown("view", chosen, views);
        const ocio::ConstColorSpaceRcPtr shown =
            config->getColorSpace(config->getDisplayViewColorSpaceName(display.c_str(), chosen.c_str()));
        if (shown && shown->isData()) {
            DARKROOM_TRY_VALUE(const ocio::GroupTransformRcPtr back,
                               space.empty() ? Result<ocio::GroupTransformRcPtr>(ocio::GroupTransform::Create())
                                             : transform_from(opened, space));
            back->setDirection(ocio::TRANSFORM_DIR_INVERSE);
            return std::make_unique<ConfigChain>(config, back);
        }
        const ocio::DisplayViewTransformRcPtr to_view = ocio::DisplayViewTransform::Create();
        to_view->setSrc(link.name.c_str());
        to_view->setDisplay(display.c_str());
        to_view->setView(chosen.c_str());
        const ocio::GroupTransformRcPtr all = ocio::GroupTransform::Create();
        all->appendTransform(transform_of(*conversion({}, link.primaries)));
        all->appendTransform(to_view);
        return std::make_unique<ConfigChain>(config, all);
    });
}

}  // namespace darkroom
