// SPDX-License-Identifier: MIT
// Pulses and layers in looks: read, written, applied; every slip with its place.

#include <gtest/gtest.h>

#include <bit>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <filesystem>
#include <fstream>

namespace darkroom {
namespace {

const std::string flat = "[post_process]\nexposure = 1.0\nvignette_enabled = false\nfog_enabled = false\n";
const std::string pulse = "[[pulse]]\nevent = \"hit\"\nparameter = \"vignette_intensity\"\namount = 0.4\n";

class LookModulation : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"exposure", "vignette", "fog", "grayscale", "tonemap"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
        folder_ = std::filesystem::path(testing::TempDir()) / "darkroom_modulation";
        std::filesystem::create_directories(folder_);
    }
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    [[nodiscard]] Result<Look> read(const std::string& text, std::vector<std::string>* warnings = nullptr) const {
        return parse_look(text, "a.toml", {.warnings = warnings, .folder = folder_});
    }
    [[nodiscard]] std::string error(const std::string& text) const {
        const Result<Look> look = read(text);
        return look ? "read" : look.error().text;
    }
    /// A float of an entry in a Composer with the look, at a time, with each of these layers at its weight.
    struct Moment {
        double time = 0;
        std::vector<std::pair<std::string, float>> weights{};
        std::optional<double> hit{};
    };
    [[nodiscard]] static float value(const Look& look, const std::string& entry, const std::string& parameter,
                                     const Moment& moment) {
        Composer composer(Device::assumed());
        EXPECT_TRUE(apply(look, composer));
        for (const auto& [layer, weight] : moment.weights) {
            const auto done = composer.set_layer_weight(layer, weight);
            EXPECT_TRUE(done) << done.error().text;
        }
        if (moment.hit) {
            EXPECT_GT(composer.fire("hit", *moment.hit), 0u);
        }
        const auto handle = composer.find(entry);
        if (!handle) return -1;
        const auto values = composer.values_at(*handle, moment.time, {});
        if (parameter == "enabled") return values.is_enabled ? 1 : 0;
        if (parameter == "opacity") return values.opacity;
        return std::bit_cast<float>(values.words[composer.info(*handle)->parameters.find(parameter)->word]);
    }

    std::filesystem::path folder_;
};

TEST_F(LookModulation, PulsesOfLooksMoveWhatTheyName) {
    const Result<Look> look =
        read(flat + pulse + "envelope = \"exponential\"\nduration = 2\n[[pulse]]\nevent = \"hit\"\n" +
             "parameter = \"fog.color\"\namount = [0.25, 0, -0.125]\nduration = 1\n");
    ASSERT_TRUE(look) << look.error().text;
    ASSERT_EQ(look->pulses.size(), 2u);
    EXPECT_EQ(look->pulses[0].entry, "vignette");
    EXPECT_EQ(look->pulses[0].parameter, "intensity");
    EXPECT_EQ(look->pulses[0].state.envelope, Envelope::Exponential);
    EXPECT_EQ(look->pulses[0].amount[3], 0.4f) << "one number is that of all";
    EXPECT_EQ(look->pulses[1].amount[2], -0.125f);
    // The effect was off: it is on with an amount of 0, and the pulse is all there is to see of it.
    EXPECT_EQ(value(*look, "vignette", "enabled", {}), 1);
    EXPECT_EQ(value(*look, "vignette", "intensity", {}), 0);
    EXPECT_FLOAT_EQ(value(*look, "vignette", "intensity", {.time = 3, .hit = 3.0}), 0.4f);
    EXPECT_EQ(value(*look, "vignette", "intensity", {.time = 5, .hit = 3.0}), 0);
    // The fog is off all the same, but there to be switched on.
    EXPECT_EQ(value(*look, "fog", "enabled", {}), 0);
}

TEST_F(LookModulation, LayersOfValuesBlendThem) {
    const Result<Look> look = read(flat +
                                   "[[layer]]\nname = \"cave\"\nweight = 0.5\n[layer.values]\nexposure = 3.0\n"
                                   "\"vignette.intensity\" = 0.8\ntonemap.opacity = 0.5\n\"fog.enabled\" = true\n");
    ASSERT_TRUE(look) << look.error().text;
    EXPECT_FLOAT_EQ(value(*look, "exposure", "exposure", {}), 2);
    EXPECT_FLOAT_EQ(value(*look, "vignette", "intensity", {}), 0.4f) << "from 0, where it was off";
    EXPECT_FLOAT_EQ(value(*look, "tonemap", "opacity", {}), 0.75f);
    EXPECT_EQ(value(*look, "fog", "enabled", {}), 1) << "at the half";
    EXPECT_EQ(value(*look, "fog", "enabled", {.weights = {{"cave", 0.4f}}}), 0);
    EXPECT_FLOAT_EQ(value(*look, "exposure", "exposure", {.weights = {{"cave", 1}}}), 3);
}

TEST_F(LookModulation, ALayerThatIsALookIsThatLookAtOne) {
    write("cave.toml", "[post_process]\nexposure = 2.0\nvignette_intensity = 0.5\n");
    const std::string text =
        "[post_process]\nexposure = 1.0\nvignette_enabled = false\nbloom_intensity = 0.2\n"
        "[[layer]]\nname = \"cave\"\nlook = \"cave.toml\"\n";
    std::vector<std::string> warnings;
    const Result<Look> look = read(text, &warnings);
    ASSERT_TRUE(look) << look.error().text;
    EXPECT_TRUE(warnings.empty()) << warnings.front();
    EXPECT_FLOAT_EQ(value(*look, "exposure", "exposure", {}), 1);
    EXPECT_FLOAT_EQ(value(*look, "exposure", "exposure", {.weights = {{"cave", 0.5f}}}), 1.5f);
    EXPECT_FLOAT_EQ(value(*look, "vignette", "intensity", {}), 0);
    EXPECT_FLOAT_EQ(value(*look, "vignette", "intensity", {.weights = {{"cave", 0.5f}}}), 0.25f);
    EXPECT_FLOAT_EQ(value(*look, "bloom", "intensity", {.weights = {{"cave", 1}}}), 0.04f) << "that look's default";
    EXPECT_EQ(value(*look, "fog", "enabled", {.weights = {{"cave", 1}}}), -1) << "off in both: not in the stack";
}

TEST_F(LookModulation, StacksAreLayeredByTheNamesOfTheirEntries) {
    write("grey.toml", "[[stack]]\neffect = \"grayscale\"\namount = 1.0\n");
    write("other.toml", "[[stack]]\neffect = \"exposure\"\nname = \"night\"\nexposure = 2.0\n");
    const std::string stack = "[[stack]]\neffect = \"grayscale\"\namount = 0.5\n[[stack]]\neffect = \"tonemap\"\n";
    const Result<Look> look = read(stack + "[[layer]]\nname = \"grey\"\nlook = \"grey.toml\"\n");
    ASSERT_TRUE(look) << look.error().text;
    EXPECT_FLOAT_EQ(value(*look, "grayscale", "amount", {.weights = {{"grey", 0.5f}}}), 0.75f);
    EXPECT_EQ(value(*look, "tonemap", "enabled", {.weights = {{"grey", 0.6f}}}), 0) << "that look has none";
    EXPECT_EQ(error(stack + "[[layer]]\nname = \"other\"\nlook = \"other.toml\"\n"),
              "a.toml:8:8: look = \"other.toml\": its entry 'night' (exposure) is not in this look, which has "
              "grayscale, tonemap");
}

TEST_F(LookModulation, ADistanceDrivesALayer) {
    const Result<Look> look = read(flat +
                                   "[[layer]]\nname = \"cave\"\nvalues = { exposure = 3.0 }\n"
                                   "distance = { near = 2, far = 6, point = [0, 4, 0] }\n");
    ASSERT_TRUE(look) << look.error().text;
    ASSERT_TRUE(look->layers.at(0).distance);
    EXPECT_EQ(look->layers[0].state.weight, 1) << "where nothing else says";
    EXPECT_FLOAT_EQ(value(*look, "exposure", "exposure", {}), 2) << "the eye is at the origin";
}

TEST_F(LookModulation, AreWrittenAsTheyAreRead) {
    write("cave.toml", "[post_process]\nexposure = 2.0\n");
    for (const std::string& text :
         {flat + pulse, flat + pulse + "envelope = \"spring\"\nduration = 0.5\n",
          flat + "[[pulse]]\nevent = \"hit\"\nparameter = \"fog.color\"\namount = [0.25, 0, -0.125]\n",
          flat + "[[layer]]\nname = \"cave\"\nlook = \"cave.toml\"\nweight = 0.25\n",
          flat + "[[layer]]\nname = \"cave\"\ndistance = { far = 4, point = [1, 2, 3] }\n[layer.values]\n" +
              "exposure = 2\nfog.color = [0, 0.5, 1]\nvignette.enabled = true\n"}) {
        const Result<Look> look = read(text);
        ASSERT_TRUE(look) << look.error().text;
        const std::string written = write_look(*look);
        const Result<Look> again = read(written);
        ASSERT_TRUE(again) << again.error().text << "\n" << written;
        EXPECT_EQ(write_look(*again), written);
        ASSERT_EQ(again->pulses.size(), look->pulses.size()) << written;
        ASSERT_EQ(again->layers.size(), look->layers.size()) << written;
        for (std::size_t i = 0; i < look->pulses.size(); ++i) {
            EXPECT_EQ(again->pulses[i].state.envelope, look->pulses[i].state.envelope);
            EXPECT_EQ(again->pulses[i].state.duration, look->pulses[i].state.duration);
            EXPECT_EQ(again->pulses[i].amount, look->pulses[i].amount);
        }
        for (std::size_t i = 0; i < look->layers.size(); ++i) {
            const LookLayer &a = again->layers[i], &b = look->layers[i];
            EXPECT_EQ(a.file, b.file);
            EXPECT_EQ(a.state.weight, b.state.weight);
            EXPECT_EQ(a.distance.has_value(), b.distance.has_value());
            if (a.distance && b.distance) {
                EXPECT_EQ(a.distance->point.z, b.distance->point.z);
            }
            ASSERT_EQ(a.values.size(), b.values.size());
            for (std::size_t k = 0; k < a.values.size(); ++k) EXPECT_EQ(a.values[k].words, b.values[k].words);
        }
    }
}

TEST_F(LookModulation, SlipsAreToldWithTheirPlaces) {
    const std::string layer = "[[layer]]\nname = \"cave\"\n";
    write("self.toml", layer + "look = \"self.toml\"\n");
    EXPECT_EQ(error("pulse = 3\n"), "a.toml:1:9: pulse = 3: expected [[pulse]] entries");
    EXPECT_EQ(error("[[pulse]]\nparameter = \"exposure\"\namount = 1\n"), "a.toml:1:1: a pulse has no key 'event'");
    EXPECT_EQ(error("[[pulse]]\nevent = \"a b\"\nparameter = \"exposure\"\namount = 1\n"),
              "a.toml:2:9: event = \"a b\": expected a name of letters, digits, '_' and '-'");
    EXPECT_EQ(error("[[pulse]]\nevent = \"hit\"\nparameter = \"exposre\"\namount = 1\n"),
              "a.toml:3:13: exposre: no effect has this parameter, did you mean 'exposure'?");
    EXPECT_EQ(error("[[pulse]]\nevent = \"hit\"\nparameter = \"tonemap.curve\"\namount = 1\n"),
              "a.toml:3:13: tonemap.curve: a pulse adds to parameters made of numbers");
    EXPECT_EQ(error("[[pulse]]\nevent = \"hit\"\nparameter = \"exposure\"\n"),
              "a.toml:1:1: a pulse has no key 'amount'");
    EXPECT_NE(error("[[pulse]]\nevent = \"hit\"\nparameter = \"exposure\"\namount = [1, 2]\n").find("a.toml:4:10: "),
              std::string::npos);
    EXPECT_EQ(error(layer), "a.toml:1:1: a layer has either a 'look' or 'values'");
    EXPECT_EQ(
        error(layer + "values = { exposure = \"much\" }\n"),
        "a.toml:3:23: exposure = \"much\": 'much' is not a number, allowed is [0, 1024] x, also in ev, stop or stops");
    EXPECT_NE(error(layer + "values = { \"fog.enabled\" = 3 }\n").find("a.toml:3:"), std::string::npos);
    EXPECT_EQ(error(layer + "values = { exposure = 1 }\n" + layer + "values = { exposure = 2 }\n"),
              "a.toml:5:8: two layers are named 'cave'");
    EXPECT_EQ(error(layer + "values = { exposure = 1 }\ndistance = { near = 3, far = 3 }\n"),
              "a.toml:4:12: distance: near = 3 and far = 3: allowed is near < far");
    EXPECT_NE(error(layer + "look = \"none.toml\"\n").find("a.toml:3:8: look = \"none.toml\": "), std::string::npos);
    // A look that layers itself is read once, without its layers.
    EXPECT_TRUE(read_look(folder_ / "self.toml")) << "a look cannot be its own layer: a slip";
    std::vector<std::string> warnings;
    ASSERT_TRUE(read(flat + pulse + "envelop = \"linear\"\nduration = 0\n", &warnings));
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(
        warnings[0],
        "a.toml:9:1: unknown key 'envelop' = \"linear\", did you mean 'envelope', which takes linear, exponential "
        "or spring?");
    EXPECT_EQ(warnings[1].substr(0, 25), "a.toml:10:12: duration = ");
    std::string many;
    for (int i = 0; i < 257; ++i) many += pulse;
    EXPECT_EQ(error(many), "a.toml:1:1: 257 entries of pulse: allowed are 256");
}

}  // namespace
}  // namespace darkroom
