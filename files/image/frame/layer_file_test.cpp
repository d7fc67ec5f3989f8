// SPDX-License-Identifier: MIT
#include "image/frame/layer_file.hpp"

#include <cmath>
#include <limits>
#include <map>

#include "image/exr/test_exr.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/display_picture.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

class ImageLayers : public WithFolder {
  protected:
    /// 2x2 pixels; the n-th sample of all is `values(n)`.
    template <class Values>
    void put_exr(const std::vector<std::string>& channels, const Values& values) const {
        std::vector<float> samples(channels.size() * 4);
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = values(i);
        test::store_floats(file("a.exr"), channels, 2, samples);
    }
};

TEST_F(ImageLayers, EveryChannelIsInOneLayer) {
    put_exr({"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "ids.m", "ids.n", "weight"}, [](auto) { return 0.5f; });
    const Result<LayerFile> opened = LayerFile::open(file("a.exr"));
    ASSERT_TRUE(opened) << opened.error().text;
    std::map<std::string, std::vector<std::string>> found;
    for (const FileLayer& layer : opened->layers()) found[layer.name] = opened->channel_names(layer);
    EXPECT_EQ(found, (decltype(found){{"color", {"R", "G", "B", "A"}},
                                      {"depth", {"Z"}},
                                      {"normals", {"N.X", "N.Y", "N.Z"}},
                                      {"ids", {"ids.m", "ids.n"}},
                                      {"weight", {"weight"}}}));
    EXPECT_EQ(opened->find("N")->name, "normals") << "the name in the file";
    EXPECT_EQ(opened->find("N.Y")->channels.size(), 1u);
    const auto unknown = opened->find("nromals");
    ASSERT_FALSE(unknown);
    EXPECT_TRUE(unknown.error().text.starts_with(file("a.exr").string() +
                                                 ": has no layer 'nromals', did you mean 'normals'? there are color"))
        << unknown.error().text;
}

TEST_F(ImageLayers, SamplesAreAsTheFileHasThem) {
    put_exr({"Z", "weight"}, [](std::size_t i) { return i == 5 ? not_a_number : 1e30f * static_cast<float>(i); });
    Result<LayerFile> opened = LayerFile::open(file("a.exr"));
    ASSERT_TRUE(opened) << opened.error().text;
    EXPECT_FALSE(opened->find("color"));
    const Result<LayerSamples> read = opened->read(*opened->find("weight"));
    ASSERT_TRUE(read) << read.error().text;
    ASSERT_EQ(read->values.size(), 4u);
    EXPECT_EQ(read->values[0], 1e30f);
    EXPECT_TRUE(std::isnan(read->values[2]));
    const auto ranges = opened->ranges(0);
    ASSERT_TRUE(ranges) << ranges.error().text;
    EXPECT_EQ((*ranges)[1].least, 1e30f);
    EXPECT_EQ((*ranges)[1].most, 7e30f);
    EXPECT_EQ((*ranges)[1].nan, 1u);
    EXPECT_EQ((*ranges)[0].nan, 0u);
}

TEST_F(ImageLayers, WhatIsComparedIsFiniteOnlyWhereTheFileIs) {
    put_exr({"R", "G", "B"}, [](std::size_t i) {
        return i == 4 ? not_a_number : i == 8 ? -std::numeric_limits<float>::infinity() : -0.5f;
    });
    const Result<ComparablePicture> picture = read_comparable(file("a.exr"));
    ASSERT_TRUE(picture) << picture.error().text;
    EXPECT_EQ(picture->encoding, PictureEncoding::SceneLinear);
    EXPECT_TRUE(std::isnan(picture->picture.at(1, 0)[1]));
    EXPECT_EQ(picture->picture.at(0, 1)[2], -std::numeric_limits<float>::infinity());
    EXPECT_EQ(picture->picture.at(0, 1)[3], 1.0f);
    const Result<FrameFile> frame = read_frame(file("a.exr"));
    ASSERT_TRUE(frame);
    EXPECT_EQ(picture->picture.at(1, 1)[0], frame->color.at(1, 1)[0]);
}

}  // namespace
}  // namespace darkroom
