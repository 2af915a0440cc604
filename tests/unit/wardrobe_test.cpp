#include "renderer/preview/wardrobe.h"
#include "tests/support/small_scenes.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

std::shared_ptr<Light> point_lamp() {
    Params params("test", "point", 1);
    params.add(tests::number_param("point3", "from", {1, 0, 5}));
    return make_light("point", {params, "", glm::mat4(1)});
}

Scene lit_square() {
    return Scene({tests::surface(tests::level_square(1, 0), tests::diffuse(0.5f))},
                 {tests::sky(1), tests::sun(3, {1, 0, 0}), point_lamp()}, Camera{},
                 tests::settings(1, 1));
}

TEST(Wardrobe, TurnsWhatIsFarAndDimsEachKindAlone) {
    const Scene scene = lit_square();
    const LightKinds kinds = light_kinds(scene);
    EXPECT_TRUE(kinds.sky && kinds.sun && kinds.lamps);
    LightSettings settings;
    settings.sky = 2;
    settings.sun = 0.5f;
    settings.sun_rotation = 90;
    settings.lamps = 0.25f;
    const Scene turned = dressed(scene, {}, settings, {0, 0, 1}, {});
    EXPECT_EQ(turned.lights()[0]->escaped({0, 0, 1}).radiance, Rgb(2));
    const LightSample sun = *turned.lights()[1]->sample({0, 0, 0}, {0.5f, 0.5f});
    EXPECT_NEAR(glm::distance(sun.direction, glm::vec3(0, 1, 0)), 0, 1e-6f);
    EXPECT_NEAR(sun.radiance.g, 1.5f, 1e-6f);
    const LightSample before = *scene.lights()[2]->sample({0, 0, 0}, {0.5f, 0.5f});
    const LightSample lamp = *turned.lights()[2]->sample({0, 0, 0}, {0.5f, 0.5f});
    EXPECT_EQ(lamp.direction, before.direction); // it stands where it stood
    EXPECT_NEAR(lamp.radiance.g, 0.25f * before.radiance.g, 1e-6f);
}

TEST(Wardrobe, LeavesWhatItWasMadeFrom) {
    const Scene scene = lit_square();
    LightSettings dark;
    dark.sky = dark.sun = dark.lamps = 0;
    const Scene night = dressed(scene, {}, dark, {0, 0, 1}, {});
    EXPECT_FALSE(night.choose_light(0.5f).has_value());
    EXPECT_TRUE(scene.choose_light(0.5f).has_value());
    EXPECT_EQ(night.surfaces()[0].mesh, scene.surfaces()[0].mesh); // shared, not copied
}

} // namespace
} // namespace rapport
