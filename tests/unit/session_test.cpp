#include "renderer/integrator/path_tracer.h"
#include "renderer/preview/fibre_view.h"
#include "renderer/preview/session.h"
#include "tests/support/sessions.h"

#include <cstring>

// The window without the window: the same calls as its input makes.

namespace rapport {
namespace {

using tests::next_picture;
using tests::SquareScene;
using tests::tick_until;

double mean(const Image& image, const std::string& channel) {
    double sum = 0;
    for (const float value : *image.find(channel))
        sum += value;
    return sum / static_cast<double>(image.find(channel)->size());
}

double difference(const Image& a, const Image& b) { return compare(a, b).rms; }

TEST(Session, ThePictureIsTheOfflineRender) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    session.resize({64, 48});
    session.orbit({4, 3});
    const std::shared_ptr<const TracedPicture> picture = next_picture(session, 64);

    const LoadedScene loaded = load_scene({files.scene()});
    const auto offline = [&](uint64_t seed, const LightSettings& lights) {
        Scene scene = dressed(*loaded.scene, {}, lights, {0, 1, 0}, {});
        scene.camera = session.camera();
        scene.settings.samples = picture->samples;
        scene.settings.seed = seed;
        return render(scene).image();
    };
    EXPECT_EQ(picture->image.data, offline(0, {}).data);
    EXPECT_TRUE(compare(picture->image, offline(1, {})).agree);
    LightSettings brighter;
    brighter.sky = 1.03f;
    EXPECT_FALSE(compare(picture->image, offline(1, brighter)).agree);
}

TEST(Session, EachActionChangesThePicture) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    session.resize({64, 48});
    constexpr int kSamples = 16; // for the test to know the noise
    Image last = next_picture(session, kSamples)->image;
    const auto expect_change = [&](const char* what, const std::function<void()>& action) {
        action();
        const Image now = next_picture(session, kSamples)->image;
        EXPECT_FALSE(compare(now, last).agree) << what;
        last = now;
    };
    expect_change("orbit", [&] { session.orbit({12, 5}); });
    expect_change("pan", [&] { session.pan({8, 2}); });
    expect_change("zoom", [&] { session.zoom(3); });
    expect_change("focus", [&] { session.focus({36, 30}); });
    expect_change("frame", [&] { session.frame_all(); });
    expect_change("rotation", [&] {
        ClothChoice turned = session.choices().at("Body");
        turned.rotation = 90;
        session.choose_cloth("Body", turned);
    });
    expect_change("lamps", [&] {
        LightSettings lights;
        lights.lamps = 0.2f;
        session.set_lights(lights);
    });
    // The same lights again are no change: the picture goes on.
    const uint64_t view = session.tracer().latest();
    session.set_lights(session.lights());
    session.tick();
    EXPECT_EQ(session.tracer().latest(), view);
    EXPECT_TRUE(compare(next_picture(session, kSamples + 8)->image, last).agree);
}

TEST(Session, SurvivesAStormOfResizes) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    for (int i = 0; i < 200; ++i) {
        session.resize({i % 7 == 0 ? 0 : 16 + 37 * i % 200, 16 + 53 * i % 150});
        session.tick();
    }
    session.resize({80, 60});
    const std::shared_ptr<const TracedPicture> picture = next_picture(session, 1);
    EXPECT_EQ(picture->image.width, 80);
    EXPECT_EQ(picture->image.height, 60);
    EXPECT_EQ(session.error(), "");
}

TEST(Session, AClothEditChangesThePictureAndTheErrorFalls) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    session.resize({64, 48});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    const Image before = next_picture(session, 16)->image;
    Cloth red = *document().cloth;
    red.warp.fibre.color = {0.75, 0.1, 0.1};
    red.weft.fibre.color = {0.75, 0.1, 0.1};
    session.edit_cloth(files.cloth(), red);
    EXPECT_TRUE(document().waiting);
    tick_until(session, [&] { return !document().waiting; });
    const double first = document().table->accuracy;
    const Image after = next_picture(session, 16)->image;
    EXPECT_GT(mean(after, "albedo.R"), 1.5 * mean(before, "albedo.R"));
    EXPECT_LT(mean(after, "albedo.G"), 0.7 * mean(before, "albedo.G"));
    tick_until(session, [&] { return document().table->accuracy < 0.4 * first; });

    const std::filesystem::path saved = session.save_cloth(files.cloth(), files / "red.toml");
    EXPECT_EQ(saved.filename(), "red.toml");
    EXPECT_EQ(session.choices().at("Body").file, saved);
    EXPECT_FALSE(session.documents().contains(files.cloth())); // nobody wears it: not measured
    tick_until(session, [&] { return session.worker().working_on() == saved; });
    EXPECT_EQ(read_cloth(files / "red.toml").warp.fibre.color, red.warp.fibre.color);
    EXPECT_EQ(read_cloth(files.cloth()).warp.fibre.color->at(0), 0.3);
}

TEST(Session, ABareModelFindsClothsToWearAndCanTakeThemOff) {
    const SquareScene files(SquareScene::Worn::measured);
    tests::write_bytes(files / "draft.wif", "");
    Session session({files / "square.glb"});
    session.resize({64, 48});
    EXPECT_TRUE(session.choices().empty());
    for (const auto& file : {files.cloth(), std::filesystem::weakly_canonical(files / "draft.wif")})
        EXPECT_EQ(std::ranges::count(session.shelf(), file), 1) << file;
    const Image bare = next_picture(session, 16)->image;
    session.choose_cloth("Body", {files.cloth(), "", 0});
    tick_until(session, [&] { return session.documents().at(files.cloth()).table != nullptr; });
    EXPECT_FALSE(compare(next_picture(session, 16)->image, bare).agree);
    session.choose_cloth("Body", {});
    EXPECT_TRUE(session.choices().empty());
    EXPECT_TRUE(compare(next_picture(session, 16)->image, bare).agree);

    // In a scene of its own cloth, that is back.
    Session dressed({files.scene()});
    dressed.choose_cloth("Body", {files / "draft.wif", "", 0});
    dressed.choose_cloth("Body", {});
    EXPECT_EQ(dressed.choices().at("Body").file, files.cloth());
}

TEST(Session, TakesFiftyClothEditsOneAfterTheOther) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    session.resize({64, 48});
    Cloth cloth = *session.documents().at(files.cloth()).cloth;
    for (int i = 0; i < 50; ++i) {
        cloth.ends_per_cm = 15 + 0.1 * i;
        if (i % 10 == 5)
            cloth.ends_per_cm = 900; // cannot be
        session.edit_cloth(files.cloth(), cloth);
        for (int tick = 0; tick < 5; ++tick) {
            session.tick();
            std::this_thread::sleep_for(std::chrono::milliseconds(4));
        }
    }
    const auto document = [&] { return session.documents().at(files.cloth()); };
    tick_until(session, [&] { return !document().waiting; });
    EXPECT_EQ(document().error, "");
    EXPECT_EQ(document().table->cloth->ends_per_cm, cloth.ends_per_cm);
    EXPECT_LT(session.worker().seconds_to_stop(), 1);
    EXPECT_GE(next_picture(session, 2)->samples, 2);
}

TEST(Session, KeepsTheOldClothUntilABrokenOneIsMended) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    tests::write_bytes(files.cloth(), "name = \"broken\"\nwarp = 3\n");
    tick_until(session, [&] { return !document().error.empty(); });
    EXPECT_NE(document().error.find("cloth.toml"), std::string::npos) << document().error;
    EXPECT_EQ(document().table->cloth->name, "coarse");
    tests::write_bytes(files.cloth(), tests::coarse_cloth("0.55"));
    tick_until(session, [&] { return document().error.empty() && !document().waiting; });
    EXPECT_EQ(document().table->cloth->warp.fibre.color->at(0), 0.55);
}

TEST(Session, KeepsEditsOfAClothThatChangesOnTheDisk) {
    const SquareScene files(SquareScene::Worn::measured);
    const std::filesystem::path folder = std::filesystem::current_path();
    std::filesystem::current_path(files.scene().parent_path());
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    const auto edit = [&](double ends_per_cm) {
        Cloth cloth = *document().cloth;
        cloth.ends_per_cm = ends_per_cm;
        session.edit_cloth(files.cloth(), cloth);
    };
    edit(17);
    tests::write_bytes(files.cloth(), tests::coarse_cloth("0.55"));
    tick_until(session, [&] { return !document().edited && !document().waiting; });
    EXPECT_EQ(read_cloth("cloth-rescued.toml").ends_per_cm, 17);
    EXPECT_EQ(session.notes().back(), "saved cloth-rescued.toml");
    EXPECT_EQ(document().cloth->warp.fibre.color->at(0), 0.55);
    edit(18);
    tests::write_bytes(files.cloth(), "broken");
    tick_until(session, [&] { return !document().error.empty(); });
    EXPECT_EQ(read_cloth("cloth-rescued-2.toml").ends_per_cm, 18);
    EXPECT_EQ(read_cloth("cloth-rescued.toml").ends_per_cm, 17);
    std::filesystem::current_path(folder);
}

TEST(Session, SavesAClothOnlyOverItsOwnFileUnlessToldAgain) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const std::filesystem::path other = std::filesystem::weakly_canonical(files / "other.toml");
    tests::write_bytes(other, "another's");
    EXPECT_EQ(session.save_cloth(files.cloth(), other), files.cloth());
    EXPECT_NE(session.notes().back().find("other.toml"), std::string::npos);
    EXPECT_EQ(tests::read_bytes(other), "another's");
    for (const char* name : {"scene.pbrt", "", "cloth"})
        EXPECT_EQ(session.save_cloth(files.cloth(), files / name, true), files.cloth()) << name;
    EXPECT_NE(tests::read_bytes(files.scene()).find("WorldBegin"), std::string::npos);
    EXPECT_EQ(session.save_cloth(files.cloth(), files.cloth()), files.cloth());
    EXPECT_EQ(session.save_cloth(files.cloth(), other, true), other);
    EXPECT_EQ(read_cloth(other).ends_per_cm, 20);
}

TEST(Session, KeepsTheOldSceneUntilABrokenOneIsMended) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    session.resize({64, 48});
    const Image before = next_picture(session, 4)->image;
    const std::string text = tests::read_bytes(files.scene());
    tests::write_bytes(files.scene(), text + "Shape \"cone\"\n");
    tick_until(session, [&] { return !session.error().empty(); });
    EXPECT_NE(session.error().find("cone"), std::string::npos) << session.error();
    EXPECT_EQ(session.scene().surfaces().size(), 2u);
    std::string mended = text;
    mended.replace(mended.find("[0.5 0.5 0.6]"), 13, "[0.1 0.1 0.1]");
    tests::write_bytes(files.scene(), mended + "# mended\n");
    tick_until(session, [&] { return session.error().empty() && !session.notes().empty(); });
    EXPECT_GT(difference(next_picture(session, 4)->image, before), 0.05);
}

TEST(Session, ThePersonsOwnViewStaysUntilTheFileHasAnotherCamera) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    session.resize({80, 60});
    const auto reload = [&](Session& session, const std::filesystem::path& file,
                            const std::string& bytes) {
        const size_t told = session.notes().size();
        tests::write_bytes(file, bytes);
        tick_until(session, [&] { return session.notes().size() > told; });
        EXPECT_EQ(session.error(), "");
    };
    std::string text = tests::read_bytes(files.scene());
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    session.orbit({12, 5});
    const Camera own = session.camera();
    replace("[0.5 0.5 0.6]", "[0.1 0.1 0.1]");
    replace("\"integer xresolution\" 64", "\"integer xresolution\" 100");
    reload(session, files.scene(), text);
    EXPECT_EQ(session.camera(), own);

    replace("0.5 0.5 3 ", "0.5 0.5 4 ");
    reload(session, files.scene(), text);
    EXPECT_EQ(session.camera().to_world, load_scene({files.scene()}).scene->camera.to_world);
    EXPECT_EQ(session.camera().resolution, glm::ivec2(80, 60));

    session.orbit({3, 0}); // and once it has been taken it is an old one, too
    const Camera turned = session.camera();
    reload(session, files.scene(), text + "# the same camera\n");
    EXPECT_EQ(session.camera(), turned);

    // A bare model has no camera: that it is framed otherwise is none of its own.
    Session bare({files / "square.glb"});
    bare.orbit({12, 5});
    const Camera of_model = bare.camera(), framed = bare.scene().camera;
    tests::GltfWriter moved = tests::quad();
    moved.json["nodes"][0]["scale"] = {3, 3, 3};
    reload(bare, files / "square.glb", moved.glb());
    EXPECT_EQ(bare.camera(), of_model);
    EXPECT_NE(bare.scene().camera, framed);
}

TEST(Session, SurfacesAreCutAnewWhereAPersonLooksClosely) {
    const SquareScene files(SquareScene::Worn::stored);
    const auto rest = [](Session& session, const std::function<bool()>& done) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(1);
        tick_until(session, [&] { return done() || std::chrono::steady_clock::now() > until; });
        return done();
    };
    const auto triangles = [](const Session& session) {
        return session.scene().surfaces().back().mesh->triangles.size();
    };
    std::string text = tests::read_bytes(files.scene());
    const std::string level = "\"integer level\" 0";
    tests::write_bytes(files / "by_sight.pbrt", text.replace(text.find(level), level.size(), ""));
    Session session({files / "by_sight.pbrt"});
    const size_t before = triangles(session);
    session.zoom(8);
    const Camera near = session.camera();
    tick_until(
        session, [&] { return !session.notes().empty(); }, 10);
    EXPECT_EQ(session.notes(), std::vector<std::string>{"surfaces cut for this view"});
    EXPECT_GT(triangles(session), 2 * before);
    EXPECT_EQ(session.camera(), near);
    const size_t close = triangles(session);

    // Not from a little nearer, nor from far away.
    for (const float steps : {4.0f, -40.0f}) {
        session.zoom(steps);
        EXPECT_FALSE(rest(session, [&] { return session.notes().size() > 1; }));
        EXPECT_EQ(triangles(session), close);
    }
    // And not what the scene cuts in its own way.
    Session stated({files.scene()});
    stated.zoom(40);
    EXPECT_FALSE(rest(stated, [&] { return !stated.notes().empty(); }));
}

TEST(Session, WhatASceneOrAClothIncludesIsReadAgainWhenItChanges) {
    const SquareScene files(SquareScene::Worn::stored);
    const std::string text = tests::read_bytes(files.scene());
    tests::write_bytes(files.scene(), text + "Include \"more.pbrt\"\n");
    tests::write_bytes(files / "more.pbrt", "Shape \"sphere\"\n");
    Session session({files.scene()});
    EXPECT_EQ(session.scene().surfaces().size(), 3u);
    tests::write_bytes(files / "more.pbrt", "Include \"yet.pbrt\"\n");
    tick_until(session, [&] { return !session.error().empty(); });
    EXPECT_NE(session.error().find("yet.pbrt"), std::string::npos) << session.error();
    tests::write_bytes(files / "yet.pbrt", "Shape \"sphere\"\nShape \"sphere\"\n");
    tick_until(session, [&] { return session.scene().surfaces().size() == 4; });
    EXPECT_EQ(session.error(), "");

    const auto write_draft = [&](const std::string& tieup) {
        tests::write_bytes(files / "draft.wif",
                           "[WIF]\nVersion=1.1\n[WEAVING]\nShafts=2\nTreadles=2\nRising Shed=yes\n"
                           "[WARP]\nThreads=2\n[WEFT]\nThreads=2\n[THREADING]\n1=1\n2=2\n"
                           "[TREADLING]\n1=1\n2=2\n[TIEUP]\n" +
                               tieup);
    };
    write_draft("1=1\n2=2\n");
    std::string cloth = tests::coarse_cloth("0.3");
    const std::string weave = "weave = \"plain\"";
    cloth.replace(cloth.find(weave), weave.size(), "draft = \"draft.wif\"");
    const std::filesystem::path file = std::filesystem::weakly_canonical(files / "drafted.toml");
    tests::write_bytes(file, cloth);
    session.choose_cloth("Body", {file, "", 0});
    const auto document = [&] { return session.documents().at(file); };
    tick_until(session, [&] { return document().cloth != nullptr; });
    const bool first_up = document().cloth->draft.up(0, 0);
    write_draft("1=2\n2=1\n\n");
    tick_until(session, [&] { return document().cloth->draft.up(0, 0) != first_up; });
    EXPECT_EQ(session.scene().surfaces().size(), 4u); // its own business, not the scene's
    EXPECT_FALSE(session.reloading());
}

/// Lets the scene name a cloth that takes long to measure.
std::string slowly_loaded(const SquareScene& files) {
    std::string cloth = tests::coarse_cloth("0.3");
    for (const auto& [from, to] :
         {std::pair("fibres = 3\n", "fibres = 3000\n"), {"diameter_um = 60", "diameter_um = 1.5"}})
        for (size_t at; (at = cloth.find(from)) != std::string::npos;)
            cloth.replace(at, std::strlen(from), to);
    tests::write_bytes(files / "slow.toml", cloth);
    std::string text = tests::read_bytes(files.scene());
    text.replace(text.find("table.bsdf"), 10, "slow.toml");
    return text;
}

TEST(Session, ASceneThatChangesWhileItReloadsIsLoadedAgain) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    const std::string text = tests::read_bytes(files.scene());
    tests::write_bytes(files.scene(), slowly_loaded(files));
    tick_until(session, [&] { return session.reloading(); });
    tests::write_bytes(files.scene(), text + "Shape \"sphere\"\n");
    tick_until(session, [&] { return session.scene().surfaces().size() == 3; });
}

TEST(Session, ClosesWhileItReloads) {
    const SquareScene files(SquareScene::Worn::stored);
    auto session = std::make_unique<Session>(SceneSource{files.scene()});
    tests::write_bytes(files.scene(), slowly_loaded(files));
    tick_until(*session, [&] { return session->reloading(); });
    const auto start = std::chrono::steady_clock::now();
    session.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST(Session, SavesThePictureThatIsShown) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    session.resize({64, 48});
    next_picture(session, 4);
    session.save_picture(files / "p.exr", files / "p.png");
    tick_until(session, [&] { return !session.notes().empty(); });
    const Image image = read_exr(files / "p.exr");
    EXPECT_EQ(image.width, 64);
    EXPECT_NE(image.find("variance.G"), nullptr);
    EXPECT_TRUE(std::filesystem::exists(files / "p.png"));
    session.save_picture(files / "absent/p.exr", files / "p.png");
    tick_until(session, [&] { return session.notes().size() == 2; });
    EXPECT_NE(session.notes().back().find("absent"), std::string::npos);
    session.save_camera();
    EXPECT_EQ(session.notes().back(), "saved " + (files / "scene-view.pbrt").string());
}

TEST(FibreView, ShowsTheClothThatIsWornFromWhereItIsTurnedTo) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    FibreView view;
    std::shared_ptr<const TracedPicture> last;
    const auto next = [&] {
        tick_until(session, [&] {
            const auto picture = view.picture();
            const bool done = picture && picture->scale == 1 && picture->samples >= 16 &&
                              (!last || picture->view > last->view);
            if (done)
                last = picture;
            return done;
        });
        return last->image;
    };
    const glm::vec3 light = glm::normalize(glm::vec3(0.5f, 0, 1));
    view.show(document().table->swatches.at(""), light, {48, 24});
    const Image first = next();
    EXPECT_GT(mean(first, "R"), 0.01);
    view.show(document().table->swatches.at(""), light, {48, 24}); // the same again
    EXPECT_EQ(view.picture()->view, last->view);
    view.orbit({10, 0});
    const Image turned = next();
    EXPECT_FALSE(compare(first, turned).agree);
    view.zoom(2);
    EXPECT_FALSE(compare(turned, next()).agree);
    view.show(document().table->swatches.at(""), glm::vec3(0, 0, -1), {48, 24}); // from behind
    EXPECT_FALSE(compare(turned, next()).agree);

    Cloth red = *document().cloth;
    red.warp.fibre.color = {0.75, 0.1, 0.1};
    red.weft.fibre.color = {0.75, 0.1, 0.1};
    for (const char* yarn : {"warp", "weft"})
        red.colourways["green"][yarn].color = {0.1, 0.75, 0.1};
    session.edit_cloth(files.cloth(), red);
    tick_until(session, [&] { return !document().waiting; });
    EXPECT_EQ(document().error, "");
    view.show(document().table->swatches.at(""), light, {48, 24});
    const Image dyed = next();
    EXPECT_GT(mean(dyed, "albedo.R"), 2 * mean(dyed, "albedo.G"));
    view.show(document().table->swatches.at("green"), light, {48, 24});
    const Image green = next();
    EXPECT_GT(mean(green, "albedo.G"), 2 * mean(green, "albedo.R"));
}

TEST(FibreView, AStoredTableHasNoFibres) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    for (const auto& [file, document] : session.documents())
        EXPECT_TRUE(document.table->swatches.empty());
}

TEST(Session, RefusesASceneThatIsNone) {
    EXPECT_THROW(Session({"absent.pbrt"}), std::exception);
    EXPECT_THROW(Session({"scene.txt"}), std::exception);
}

} // namespace
} // namespace rapport
