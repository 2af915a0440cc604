#include "renderer/core/image.h"
#include "tests/support/file_bytes.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/run_program.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace rapport {
namespace {

using tests::run_program;
const std::string kSource = RAPPORT_SOURCE_DIR;

class Command : public testing::Test {
  protected:
    /// The program must refuse: status 2, one line that holds each of `told`, no other output, and
    /// no new file.
    void expect_refused(const std::vector<std::string>& arguments,
                        const std::vector<std::string>& told) {
        const auto files = [&] {
            const std::filesystem::directory_iterator entries(folder_.path());
            return std::distance(begin(entries), end(entries));
        };
        const auto before = files();
        const tests::ProgramRun run = run_program(arguments, folder_.path().string());
        EXPECT_EQ(run.status, 2) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
        for (const std::string& text : told)
            EXPECT_NE(run.err.find(text), std::string::npos) << text << " in: " << run.err;
        EXPECT_EQ(files(), before) << arguments[0];
    }
    std::string file(const std::string& name, const std::string& bytes) {
        tests::write_bytes(folder_ / name, bytes);
        return (folder_ / name).string();
    }
    /// The plain cloth with one line replaced.
    std::string cloth(const std::string& from, const std::string& to) {
        std::string text = tests::read_bytes(kSource + "/scenes/cloths/viscose-plain.toml");
        const size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        return file("cloth.toml", text);
    }

    tests::TemporaryFolder folder_;
};

TEST_F(Command, RefusesAWrongCommandLine) {
    expect_refused({}, {"vgsp, render, view, diff, info, export"});
    expect_refused({"weave"}, {"found weave"});
    expect_refused({"vgsp"}, {"cloth"});
    expect_refused({"vgsp", "a.toml", "--accuracy", "0"}, {"--accuracy"});
    expect_refused({"vgsp", kSource + "/scenes/cloths/viscose-plain.toml", "--incidence", "95,0"},
                   {"--incidence", "95,0"});
    expect_refused({"vgsp", kSource + "/scenes/cloths/viscose-plain.toml", "--incidence", "30"},
                   {"two angles"});
    expect_refused({"vgsp", kSource + "/scenes/cloths/viscose-plain.toml", "--plane", "0",
                    "--theta-in", "45", "--resume"},
                   {"--resume", "fewer --plane"});
    expect_refused({"render", "scene.txt"}, {"scene.txt", ".pbrt"});
    expect_refused({"render", kSource + "/scenes/quickstart.pbrt", "--size", "0x10"}, {"--size"});
    expect_refused({"render", kSource + "/scenes/quickstart.pbrt", "-o", "a.jpg"}, {"a.jpg"});
    expect_refused({"render", kSource + "/scenes/quickstart.pbrt", "-o", "none/a.exr"},
                   {"none/a.exr"}); // before the scene is built, which lacks its table here
    expect_refused({"info", "what.xyz"}, {"what.xyz"});
}

TEST_F(Command, RefusesNumbersThatAreNone) {
    const std::string plain = kSource + "/scenes/cloths/viscose-plain.toml";
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"vgsp", plain, "--plane", "nan", "--theta-in", "30"},
             {"vgsp", plain, "--plane", "0", "--theta-in", "nan"},
             {"vgsp", plain, "--accuracy", "nan"},
             {"vgsp", plain, "--accuracy", "inf"},
             {"vgsp", plain, "--accuracy", "0"},
             {"vgsp", plain, "--max-time", "nan"},
             {"vgsp", plain, "--max-rays", "0"},
             {"vgsp", plain, "--max-rays", "-1"},
             {"vgsp", plain, "--seed", "-1"},
             {"render", kSource + "/scenes/quickstart.pbrt", "--error", "nan"},
             {"render", kSource + "/scenes/quickstart.pbrt", "--accuracy", "nan"},
             {"diff", "a.exr", "b.exr", "--max", "nan"}}) {
        const auto option = std::ranges::find_if(arguments, [&](const std::string& text) {
            return text.starts_with("--") && text != "--plane" && text != "--theta-in";
        });
        const std::string name = option != arguments.end() ? *option
                                 : arguments[3] == "nan"   ? "--plane"
                                                           : "--theta-in";
        const std::string found = arguments[3] == "nan" ? "nan" : arguments.back();
        expect_refused(arguments,
                       {"command line: " + name + ": expected", "found " + found + "\n"});
    }
}

TEST_F(Command, RefusesPlacesThatCannotBeWrittenBeforeItTraces) {
    const std::string plain = kSource + "/scenes/cloths/viscose-plain.toml";
    for (const char* name : {"a.bsdf", "b.bsdf.part", "c.svg"})
        std::filesystem::create_directory(folder_ / name);
    // Each would go on for hours.
    const auto table = [&](const std::string& output) -> std::vector<std::string> {
        return {"vgsp", plain, "--accuracy", "1e-4", "-o", (folder_ / output).string()};
    };
    expect_refused(table("a.bsdf"), {"a.bsdf: expected a plain file", "found a folder"});
    expect_refused(table("b.bsdf"), {"b.bsdf.part: expected a plain file"});
    expect_refused(table("none/d.bsdf"), {"none/d.bsdf: expected an existing folder"});
    for (const char* output : {"c.csv", "c.svg", "none/c.csv"}) {
        std::vector<std::string> scan = table(output);
        scan.insert(scan.end(), {"--plane", "0", "--theta-in", "30"});
        expect_refused(scan, {"expected"});
    }
}

TEST_F(Command, RefusesFilesThatAreMissing) {
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"vgsp", "none.toml"},
                                               {"vgsp", "none.wif"},
                                               {"render", "none.pbrt"},
                                               {"render", "none.glb"},
                                               {"info", "none.bsdf"},
                                               {"info", "none.exr"},
                                               {"export", "none.bsdf", "--to", "csv"},
                                               {"diff", "none.exr", "none.exr"}})
        expect_refused(arguments, {"none.", "found no "});
}

TEST_F(Command, RefusesClothsThatCannotBe) {
    expect_refused({"vgsp", cloth("fibres = 37", "fibers = 37")},
                   {"cloth.toml:", "fibers", "fibres"});
    expect_refused({"vgsp",
                    cloth("[warp]", "[colourway.dark]\nwarp.color = [0.1, 0.1, 0.1]\n[warp]"),
                    "--plane", "0", "--theta-in", "30"},
                   {"cloth.toml:colourway: expected none for a scan", "found 1"});
    expect_refused({"vgsp", cloth("ends_per_cm = 50", "ends_per_cm = 0")},
                   {"ends_per_cm", "found 0"});
    expect_refused({"vgsp", cloth("ends_per_cm = 50", "ends_per_cm = 150")}, {"cloth.toml", "150"});
    expect_refused({"vgsp", cloth("weave = \"plain\"", "rows = [\"110\", \"101\", \"100\"]")},
                   {"end 1"});
}

TEST_F(Command, RefusesDamagedFiles) {
    const tests::ProgramRun made = run_program(
        {"vgsp", kSource + "/scenes/cloths/viscose-plain.toml", "--incidence", "20,30", "--side",
         "front", "--max-rays", "2000", "-o", (folder_ / "whole.bsdf").string()});
    ASSERT_EQ(made.status, 0) << made.err;
    const std::string table = tests::read_bytes(folder_ / "whole.bsdf");
    expect_refused({"info", file("half.bsdf", table.substr(0, table.size() / 2))}, {"half.bsdf"});
    expect_refused({"render", kSource + "/scenes/garments/dress.glb", "--cloth",
                    "Body=" + (folder_ / "whole.bsdf").string(), "-o", "out.exr"},
                   {"whole.bsdf", "partial"});
    const std::string dress = tests::read_bytes(kSource + "/scenes/garments/dress.glb");
    expect_refused({"render", file("half.glb", dress.substr(0, dress.size() / 2))}, {"half.glb"});
    expect_refused({"diff", file("half.exr", "v/1\x01"), "half.exr"}, {"half.exr"});
    expect_refused({"render", file("bad.pbrt", "WorldBegin\nShape \"torus\"\n")},
                   {"bad.pbrt:2", "torus", "gltf"});
}

TEST_F(Command, RefusesGarmentsWithoutUVsOrWithUnknownCompression) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    expect_refused({"render", (data / "gltf" / "shorts_meshopt_noUV.glb").string()},
                   {"EXT_meshopt_compression"});
}

TEST_F(Command, TellsADraftToPrograms) {
    const tests::ProgramRun run =
        run_program({"info", kSource + "/scenes/drafts/twill-2-2-z.wif", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["kind"], "draft");
    EXPECT_EQ(json["ends"], json["rows"][0].get<std::string>().size());
    EXPECT_EQ(json["picks"], json["rows"].size());
}

TEST_F(Command, DrawsADraftInHalfBlocks) {
    const std::string told = run_program({"info", kSource + "/scenes/drafts/satin5.wif"}).out;
    // Of five picks the lowest stands alone, and the sides end with it.
    EXPECT_TRUE(told.ends_with("│█▀█▄█│\n│██▀█▄│\n╵ ▀▀▀▀╵\n")) << told;
    const std::string even = run_program({"info", kSource + "/scenes/drafts/plain.wif"}).out;
    EXPECT_TRUE(even.ends_with("│▄▀│\n")) << even;
}

TEST_F(Command, TellsAnImageWithoutBlankLines) {
    Image image(1, 1, {"R", "G", "B"});
    image.attributes["tables"] = "one\n"; // lines, each with its end
    write_exr(image, folder_ / "a.exr");
    const std::string told = run_program({"info", (folder_ / "a.exr").string()}).out;
    EXPECT_TRUE(told.ends_with("tables: one\n")) << told;
}

TEST_F(Command, MeasuresTellsAndExportsATable) {
    const std::string table = (folder_ / "plain.bsdf").string();
    ASSERT_EQ(run_program({"vgsp", kSource + "/scenes/cloths/viscose-plain.toml", "--incidence",
                           "30,45", "--max-rays", "4000", "-o", table})
                  .status,
              0);
    const auto json = nlohmann::json::parse(run_program({"info", table, "--json"}).out);
    EXPECT_EQ(json["kind"], "bsdf");
    ASSERT_EQ(json["incident"].size(), 2); // both sides
    const auto& from = json["incident"][0];
    EXPECT_EQ(from["side"], "front");
    EXPECT_NEAR(from["theta"].get<double>(), 30, 1e-9);
    EXPECT_NEAR(from["phi"].get<double>(), 45, 1e-9);
    for (size_t band = 0; band < 3; ++band) {
        double sum = 0;
        for (const char* share : {"R", "T", "unscattered", "absorbed", "capped"})
            sum += from[share][band].get<double>();
        EXPECT_NEAR(sum, 1, 1e-5);
    }
    ASSERT_EQ(run_program({"export", table, "--to", "csv"}, folder_.path().string()).status, 0);
    const std::string csv = tests::read_bytes(folder_ / "plain.csv");
    EXPECT_TRUE(csv.starts_with("side,theta_i,phi_i,theta_o,phi_o,solid_angle,band,intensity\n"));
    // Σ I·Ω over the rows of one direction and band is its R + T.
    double sum = 0;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        std::vector<std::string> field;
        for (std::string value; std::getline(fields, value, ',');)
            field.push_back(value);
        if (field[0] == "front" && field[6] == "R")
            sum += std::stod(field[5]) * std::stod(field[7]);
    }
    EXPECT_NEAR(sum, from["R"][0].get<double>() + from["T"][0].get<double>(), 1e-5);
}

TEST_F(Command, GoesOnWithAMeasurementThatRanOutOfTimeOrRays) {
    const std::filesystem::path table = folder_ / "plain.bsdf", part = folder_ / "plain.bsdf.part";
    std::vector<std::string> vgsp{"vgsp",
                                  kSource + "/scenes/cloths/viscose-plain.toml",
                                  "--incidence",
                                  "30,45",
                                  "--side",
                                  "front",
                                  "--accuracy",
                                  "0.15",
                                  "--threads",
                                  "1",
                                  "--realisations",
                                  "1",
                                  "-o",
                                  table.string()};
    const auto accuracy = [&] {
        const tests::ProgramRun told = run_program({"info", table.string(), "--json"});
        return nlohmann::json::parse(told.out)["accuracy"].get<double>();
    };
    std::vector<std::string> resumed = vgsp;
    resumed.push_back("--resume");
    const std::vector<std::pair<std::vector<std::string>, std::string>> bounds{
        {{"--max-time", "1e-3"}, "out of time"}, {{"--max-rays", "2000"}, "out of rays"}};
    for (const auto& [bound, told] : bounds) {
        std::vector<std::string> bounded = vgsp;
        bounded.insert(bounded.end(), bound.begin(), bound.end());
        const tests::ProgramRun first = run_program(bounded);
        ASSERT_EQ(first.status, 0) << first.err;
        EXPECT_NE(first.out.find(told), std::string::npos) << first.out;
        EXPECT_TRUE(std::filesystem::exists(part));
        EXPECT_GT(accuracy(), 0.15);
        EXPECT_EQ(run_program(resumed).status, 0);
        EXPECT_FALSE(std::filesystem::exists(part));
        EXPECT_LE(accuracy(), 0.15);
    }
}

TEST_F(Command, RendersTheSamePixelsWithAnyThreadsAndDiffTellsThemApart) {
    const std::string scene = file("scene.pbrt", R"(
        LookAt 0 0 3  0 0 0  0 1 0
        Camera "perspective" "float fov" 60
        Film "rgb" "integer xresolution" 32 "integer yresolution" 24
        WorldBegin
        LightSource "infinite" "rgb L" [1 1 1]
        Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  0 1 0] "integer indices" [0 1 2]
    )");
    const std::string folder = folder_.path().string();
    for (const char* threads : {"1", "2", "7"})
        ASSERT_EQ(run_program({"render", scene, "--threads", threads, "-o",
                               "t" + std::string(threads) + ".exr", "-o", "t.png"},
                              folder)
                      .status,
                  0);
    ASSERT_EQ(run_program({"render", scene, "--seed", "5", "-o", "other.exr"}, folder).status, 0);
    EXPECT_EQ(run_program({"diff", "t1.exr", "t2.exr", "--max", "0"}, folder).status, 0);
    EXPECT_EQ(run_program({"diff", "t1.exr", "t7.exr", "--max", "0"}, folder).status, 0);
    EXPECT_EQ(run_program({"diff", "t1.exr", "other.exr", "--max", "0"}, folder).status, 1);
    EXPECT_EQ(run_program({"diff", "t1.exr", "other.exr"}, folder).status, 0) << "noise alone";
    EXPECT_TRUE(std::filesystem::exists(folder_ / "t.png"));
}

} // namespace
} // namespace rapport
