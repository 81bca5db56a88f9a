// SPDX-License-Identifier: GPL-3.0-or-later
// study.toml: every key, its errors, its order, and the way back.
#include <import/study.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

const std::string kModel = "[model]\nfile = \"a.obj\"\n";  // two lines

Study readText(const std::string& text) {
  const TempFolder folder;
  folder.write("p.csv", "x,y,z\n1,2,0.8\n3,4,0.8\n");
  return readStudy(folder.write("study.toml", text));
}

std::string errorOfText(const std::string& text) {
  return inputErrorOf([&] { readText(text); });
}

const std::string kWhole = R"(
[model]
file = "models/office.glb"
units = "mm"
up = "z"
[model.subdivide."chair*"]
scheme = "catmark"
tolerance_m = 0.002
[model.subdivide."all"]
scheme = "none"

[site]
latitude = -12.5
longitude = 100
time_zone = 5.5
north = 30
external_diffuse_lx = 14000

[materials."wall*"]
reflectance = 0.5
[materials."glass \"a\""]
transmittance = [0.6, 0.65, 0.6]
panes = 2
diffusing = false
[materials."a lamp"]
reflectance = 0
exitance = 3000

[sky]
type = "cie-12"
diffuse_horizontal_lx = 7761.5
direct_normal_lx = 0
sun = { altitude = 35.836, azimuth = 141.922 }

[ground]
reflectance = 0.15
model = "uniform"

[glazing]
dirt = 0.9
frame = 0.8

[[grid]]
name = "Desks"
room = "Office*"
height = 0.75
spacing = 0.5
inset = 0.1
[[grid]]
polygon = [[0, 0], [3.5, 0], [0, 2]]
[[grid]]
name = "points"
points = "p.csv"

[[view]]
name = "entrance"
projection = "perspective"
eye = [1.8, 7.9, 1.6]
target = [1.8, 0, 1.2]
up = [0, 0, 1]
field_of_view = 60
size = [640, 480]
exposure_ev = -3.5
[[view]]
eye = [0, 0, 1]
target = [1, 0, 1]
exposure_ev = "auto"

[accuracy]
target = "7%"
time_limit_s = 0

[report]
norms = ["en17037"]
)";

TEST(Study, ReadsEveryKey) {
  const Study study = readText(kWhole);
  EXPECT_EQ(study.modelFileAsWritten, "models/office.glb");
  EXPECT_EQ(study.modelFile.filename(), "office.glb");
  EXPECT_TRUE(study.modelFile.is_absolute()) << "beside the study";
  EXPECT_EQ(study.model.units, "mm");
  EXPECT_EQ(study.model.upAxis, "z");
  ASSERT_EQ(study.model.subdivide.size(), 2U);
  EXPECT_EQ(study.model.subdivide[0].object, "chair*");
  EXPECT_EQ(study.model.subdivide[0].tolerance_m, 0.002);
  EXPECT_EQ(study.model.subdivide[1].scheme, "none");
  EXPECT_EQ(study.site.north_deg, 30.0);
  EXPECT_EQ(study.site.timeZone_h, 5.5);
  EXPECT_EQ(study.sky.cieType, 12);
  EXPECT_EQ(study.sky.sun_deg, glm::dvec2(35.836, 141.922));
  EXPECT_EQ(study.groundReflectance, 0.15);
  EXPECT_EQ(study.dirtFactor * study.frameFactor, 0.9 * 0.8);
  EXPECT_EQ(study.accuracy, 0.07);
}

TEST(Study, ReadsGridsAndViews) {
  const Study study = readText(kWhole);
  ASSERT_EQ(study.grids.size(), 3U);
  EXPECT_EQ(study.grids[0].room, "Office*");
  EXPECT_EQ(study.grids[0].spacing_m, 0.5);
  EXPECT_EQ(study.grids[1].name, "Grid 2");
  EXPECT_EQ(study.grids[1].polygon_m.size(), 3U);
  EXPECT_EQ(study.grids[1].height_m, 0.85);
  ASSERT_EQ(study.grids[2].points.size(), 2U);
  EXPECT_EQ(study.grids[2].points[1], (std::array<double, 6>{3, 4, 0.8, 0, 0, 1}));
  ASSERT_EQ(study.views.size(), 2U);
  EXPECT_EQ(study.views[0].exposure_ev, -3.5);
  EXPECT_EQ(study.views[0].size_px, (std::array{640, 480}));
  EXPECT_FALSE(study.views[1].exposure_ev);
}

TEST(Study, KeepsMaterialRulesInTheFilesOrder) {
  const Study study = readText(kWhole);
  ASSERT_EQ(study.materials.size(), 3U);
  EXPECT_EQ(study.materials[0].glob, "wall*");
  EXPECT_EQ(study.materials[1].glob, "glass \"a\"");
  EXPECT_EQ(study.materials[1].transmittance, glm::dvec3(0.6, 0.65, 0.6));
  EXPECT_EQ(study.materials[2].glob, "a lamp");
  EXPECT_EQ(study.materials[2].exitance_lm_m2, glm::dvec3(3000));
  const Study dotted = readText(kModel + "[materials]\nz.reflectance = 0.1\n\"a\" = { reflectance = 0.2 }\n");
  EXPECT_EQ(dotted.materials.at(0).glob, "z");
}

TEST(Study, ReadsBackWhatItWrites) {
  const TempFolder folder;
  folder.write("p.csv", "x,y,z\n1,2,0.8\n3,4,0.8\n");
  const Study first = readStudy(folder.write("a.toml", kWhole));
  const Study second = readStudy(folder.write("b.toml", studyToml(first)));
  EXPECT_EQ(second.modelFileAsWritten, first.modelFileAsWritten);
  EXPECT_EQ(second.model.units, first.model.units);
  EXPECT_EQ(second.model.subdivide.size(), first.model.subdivide.size());
  EXPECT_EQ(second.accuracy, first.accuracy);
  EXPECT_EQ(second.grids.at(2).points, first.grids.at(2).points);
  EXPECT_EQ(second.views.at(0).exposure_ev, first.views.at(0).exposure_ev);
  EXPECT_EQ(second.sky.sun_deg, first.sky.sun_deg);
  ASSERT_EQ(second.materials.size(), first.materials.size());
  for (std::size_t i = 0; i < first.materials.size(); ++i) {
    EXPECT_EQ(second.materials[i].glob, first.materials[i].glob);
    EXPECT_EQ(second.materials[i].transmittance, first.materials[i].transmittance);
  }
  Study plain = second;
  plain.assumptions = first.assumptions;
  EXPECT_EQ(studyToml(plain), studyToml(first));
}

TEST(Study, ReadsBackTheStudyOfAModel) {
  const TempFolder folder;
  const Study first = studyOfModel("rooms/my \"room\".obj");
  const std::string text = studyToml(first);
  EXPECT_TRUE(contains(text, "# Assumed: The sky is")) << text;
  EXPECT_EQ(first.grids.size(), 1U);
  const Study second = readStudy(folder.write("a.toml", text));
  EXPECT_EQ(second.modelFileAsWritten, "rooms/my \"room\".obj");
  Study plain = second;
  plain.assumptions = first.assumptions;
  EXPECT_EQ(studyToml(plain), text);
}

TEST(Study, NamesTheNearestKnownKey) {
  const std::string key = errorOfText(kModel + "[sky]\n\ntipe = \"uniform\"\n");
  EXPECT_TRUE(contains(key, "study.toml:5: [sky] has no key \"tipe\"; did you mean \"type\"?")) << key;
  const std::string table = errorOfText(kModel + "[skyy]\n");
  EXPECT_TRUE(contains(table, "study.toml:3: has no key \"skyy\"; did you mean \"sky\"?")) << table;
  const std::string grid = errorOfText(kModel + "[[grid]]\nname = \"a\"\nspacings = 1\n");
  EXPECT_TRUE(contains(grid, "study.toml:5: [[grid]] has no key \"spacings\"; did you mean \"spacing\"?"))
      << grid;
  const std::string far = errorOfText(kModel + "[ground]\nxylophone = 1\n");
  EXPECT_TRUE(contains(far, "did you mean \"")) << far;
}

TEST(Study, RefusesReflectancesFromOneUp) {
  const std::string message = errorOfText(kModel + "[materials.\"wall\"]\nreflectance = 1.2\n");
  EXPECT_TRUE(contains(message, "study.toml:4: [materials.\"wall\"] reflectance 1.2 is not below 1"))
      << message;
  EXPECT_TRUE(contains(errorOfText(kModel + "[materials.a]\nreflectance = [0.5, 1, 0]\n"), "is not below 1"));
  EXPECT_TRUE(contains(errorOfText(kModel + "[materials.a]\nreflectance = -0.1\n"), "is below 0"));
}

TEST(Study, RefusesWrongTypesAndRanges) {
  for (const std::string text : {"[sky]\ndiffuse_horizontal_lx = \"much\"\n",
                                 "[sky]\ndiffuse_horizontal_lx = -1\n",
                                 "[sky]\ndiffuse_horizontal_lx = nan\n",
                                 "[site]\nlatitude = 91\n",
                                 "[ground]\nreflectance = 1\n",
                                 "[glazing]\ndirt = 0\n",
                                 "[materials.a]\npanes = 1.5\n",
                                 "[materials.a]\npanes = 0\n",
                                 "[materials.a]\ntransmittance = 1.01\n",
                                 "[materials.a]\nreflectance = [0.1, 0.2]\n",
                                 "[materials]\na = 1\n",
                                 "[[grid]]\nspacing = 0\n",
                                 "[[grid]]\npolygon = [[0, 0], [1, 1]]\n",
                                 "[[grid]]\npoints = \"../p.csv\"\n",
                                 "[[grid]]\npoints = \"gone.csv\"\n",
                                 "[[grid]]\nroom = \"a\"\npoints = \"p.csv\"\n",
                                 "[grid]\nname = \"a\"\n",
                                 "[[view]]\neye = [0, 0, 0]\n",
                                 "[[view]]\neye = [0, 0, 0]\ntarget = [0, 0, 1]\n",
                                 "[[view]]\neye = [0, 0, 0]\ntarget = [0, 1, 1]\nsize = [0, 10]\n",
                                 "[[grid]]\nname = \"a\"\n[[grid]]\nname = \"a\"\n",
                                 "[accuracy]\ntarget = \"60%\"\n",
                                 "[accuracy]\ntarget = 5\n",
                                 "[sky]\ntype = \"cie-17\"\n",
                                 "[sky]\ntype = \"cie-012\"\n",
                                 "[sky]\ntype = \"cie-12\"\n",
                                 "[sky]\nsun = { altitude = 4 }\n",
                                 "[sky]\ndirect_normal_lx = 5\n",
                                 "[materials.a]\nglass = \"x\"\n",
                                 "[[opening]]\npolygon = [[0,0,1]]\n",
                                 "[[opening]]\nheight = 2\n",
                                 "[[opening]]\npolygon = [[0,0,0], [1,0,0], [2,0,0]]\n",
                                 "[[opening]]\npolygon = [[0,0,0], [1,0,0], [1,1,0], [0,1,0.2]]\n",
                                 "[ground]\nmodel = \"wet\"\n",
                                 "[materials.a]\nglass = \"cie171-6mm\"\ntransmittance = 0.5\n",
                                 "[sky]\ntype = \"perez\"\n",
                                 "[sky]\ntime = \"2026-03-21T10:00:00\"\n",
                                 "[sky]\ntime = 2026-03-21\n",
                                 "[sky]\ntime = 1726-03-21T10:00:00\n",
                                 "[sky]\ntime = 2026-03-21T10:00:00\nsun = { altitude = 4, azimuth = 9 }\n",
                                 "[sky]\ndirect_normal_w_m2 = 1\ndiffuse_horizontal_w_m2 = 1\n",
                                 "[sky]\ntype = \"perez\"\ntime = 2026-03-21T10:00:00\n"
                                 "direct_normal_w_m2 = 1\n",
                                 "sky = 3\n"}) {
    const std::string message = errorOfText(kModel + text);
    EXPECT_TRUE(contains(message, "study.toml:") || contains(message, "gone.csv")) << text << message;
  }
}

TEST(Study, ViewsAllRoundAreReadAndWritten) {
  const std::string places = "eye = [0, 0, 0]\ntarget = [0, 1, 0]\n";
  const Study study = readText(kModel + "[[view]]\nprojection = \"fisheye\"\nexr_bits = 32\n" + places +
                               "[[view]]\nprojection = \"panorama\"\npng_bits = 16\n" + places);
  for (const Study& read : {study, readText(studyToml(study))}) {
    ASSERT_EQ(read.views.size(), 2U);
    EXPECT_EQ(read.views[0].projection, Projection::fisheye);
    EXPECT_EQ(read.views[0].fieldOfView_deg, 180.0);
    EXPECT_EQ(read.views[0].size_px, (std::array{720, 720}));
    EXPECT_EQ(read.views[0].exrBits, 32);
    EXPECT_EQ(read.views[0].pngBits, 8);
    EXPECT_EQ(read.views[1].projection, Projection::panorama);
    EXPECT_EQ(read.views[1].size_px, (std::array{1440, 720}));
    EXPECT_EQ(read.views[1].exrBits, 16);
    EXPECT_EQ(read.views[1].pngBits, 16);
  }
  for (const std::string wrong :
       {"projection = \"fish\"\n", "projection = \"panorama\"\nfield_of_view = 90\n",
        "projection = \"panorama\"\nsize = [100, 100]\n", "png_bits = 12\n"}) {
    EXPECT_TRUE(contains(errorOfText(kModel + "[[view]]\n" + wrong + places), "study.toml:")) << wrong;
  }
}

TEST(Study, SaysWhatThisVersionCannotDo) {
  const std::string message = errorOfText(kModel + "[accuracy]\ntime_limit_s = 5\n");
  EXPECT_TRUE(contains(message, "not supported by this version")) << message;
  EXPECT_TRUE(contains(message, "study.toml:")) << message;
}

// Sensors lie on the surface unless a distance is stated.
TEST(Study, PutsGridsOnSurfaces) {
  const Study study = readText(kModel + "[[grid]]\nsurface = \"ceiling*\"\n[[grid]]\nroom = \"Hall\"\n");
  for (const Study& read : {study, readText(studyToml(study))}) {
    ASSERT_EQ(read.grids.size(), 2U);
    EXPECT_EQ(read.grids[0].surface, "ceiling*");
    EXPECT_EQ(read.grids[0].height_m, 0.0);
    EXPECT_FALSE(read.grids[1].surface);
    EXPECT_EQ(read.grids[1].height_m, 0.85);
  }
  EXPECT_TRUE(contains(errorOfText(kModel + "[[grid]]\nsurface = \"a\"\nroom = \"b\"\n"), "study.toml:"));
  EXPECT_TRUE(contains(errorOfText(kModel + "[[grid]]\nsurface = \"a\"\nheight = -1\n"), "study.toml:"));
}

TEST(Study, TakesADayForSunlight) {
  const Study study = readText(kModel + "[sunlight]\ndate = 2025-02-01\naltitude_min = 11\n");
  for (const Study& read : {study, readText(studyToml(study))}) {
    EXPECT_EQ(dateText(read.sunlight.date), "2025-02-01");
    EXPECT_EQ(read.sunlight.leastAltitude_deg, 11.0);
  }
  EXPECT_EQ(dateText(readText(kModel).sunlight.date), "2026-03-21");
  for (const std::string wrong : {"date = \"2025-02-01\"", "date = 2025-02-01T10:00:00", "date = 1949-02-01",
                                  "altitude_min = 91", "day = 3"}) {
    EXPECT_TRUE(contains(errorOfText(kModel + "[sunlight]\n" + wrong + "\n"), "study.toml:")) << wrong;
  }
}

TEST(Study, KnowsNormsByName) {
  EXPECT_EQ(readText(kModel + "[report]\nnorms = [\"leed\"]\n").norms, std::vector<std::string>{"leed"});
  const std::string message = errorOfText(kModel + "[report]\nnorms = [\"leeds\"]\n");
  EXPECT_TRUE(contains(message, "leeds") && contains(message, "en17037")) << message;
}

TEST(Study, PlacesLuminaires) {
  const TempFolder temp;
  temp.write("lamps/down.ies", "TILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n100 0\n");
  const auto file = temp.write("study.toml", kModel +
                                                 "[[luminaire]]\nfile = \"lamps/down.ies\"\n"
                                                 "position = [1, 2, 3]\naim = [0, 2, 0]\nrotation = 90\n"
                                                 "flux_factor = 0.8\n"
                                                 "array = { count = [3, 2], step = [1.5, -2] }\n"
                                                 "[[luminaire]]\nname = \"bulb\"\nintensity_cd = 50\n"
                                                 "position = [0, 0, 1]\n"
                                                 "[[luminaire]]\nintensity_cd = 50\nlambertian = true\n"
                                                 "flux_factor = 0\nposition = [0, 0, 1]\n");
  const Study study = readStudy(file);
  ASSERT_EQ(study.luminaires.size(), 3U);
  const std::vector<Luminaire> luminaires = luminairesOf(study);
  ASSERT_EQ(luminaires.size(), 7U);  // one is switched off
  EXPECT_EQ(luminaires[5].position_m, glm::dvec3(4, 0, 3));
  EXPECT_EQ(luminaires[5].name, "Luminaire 1");
  EXPECT_EQ(luminaires[5].factor, 0.8);
  EXPECT_NEAR(luminaires[5].axes[0].z, 1.0, 1e-12);  // C0 was turned to +y, then raised with the aim
  EXPECT_EQ(luminaires[5].photometry.get(), luminaires[0].photometry.get());
  EXPECT_NEAR(luminaires[6].flux_lm(), 628.3185, 1e-3);
  Study again = readStudy(temp.write("again.toml", studyToml(study)));
  again.assumptions = study.assumptions;
  EXPECT_EQ(studyToml(again), studyToml(study));
}

TEST(Study, RefusesLuminairesThatCannotBe) {
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"position = [0, 0, 1]\n", "needs either file"},
           {"intensity_cd = 5\n", "needs position"},
           {"file = \"a.ies\"\nintensity_cd = 5\nposition = [0, 0, 1]\n", "needs either file"},
           {"file = \"gone.ies\"\nposition = [0, 0, 1]\n", "photometric file \"gone.ies\" not found"},
           {"file = \"../a.ies\"\nposition = [0, 0, 1]\n", "in the study's folder"},
           {"file = \"a.txt\"\nlambertian = true\nposition = [0, 0, 1]\n", "goes with intensity_cd"},
           {"intensity_cd = 0\nposition = [0, 0, 1]\n", "intensity_cd"},
           {"intensity_cd = 5\nposition = [0, 0, 1]\naim = [0, 0, 0]\n", "aim has no length"},
           {"intensity_cd = 5\nposition = [0, 0, 1]\narray = { count = [2, 0], step = [1, 1] }\n", "count"},
           {"intensity_cd = 5\nposition = [0, 0, 1]\narray = { count = [2, 2] }\n", "needs count"},
           {"intensity_cd = 5\nposition = [0, 0, 1]\nflux_facter = 3\n", "flux_factor"}}) {
    const std::string message = errorOfText(kModel + "[[luminaire]]\n" + text);
    EXPECT_TRUE(contains(message, "study.toml:")) << message;
    EXPECT_TRUE(contains(message, says)) << text << message;
  }
}

TEST(Study, SaysWhereItIsNoToml) {
  EXPECT_TRUE(contains(errorOfText("[model]\nfile = \n"), "study.toml:2: is not valid TOML"));
  EXPECT_TRUE(contains(errorOfText("[sky]\n"), "names no model"));
  EXPECT_TRUE(contains(inputErrorOf([] { readStudy("gone.toml"); }), "study file not found: gone.toml"));
}

TEST(Study, ReadsTheSunByTimeAndWritesItAgain) {
  const Study study = readText(kModel +
                               "[sky]\ntype = \"perez\"\ntime = 2026-03-21T10:00:30-03:30\n"
                               "direct_normal_w_m2 = 700\ndiffuse_horizontal_w_m2 = 90\n");
  ASSERT_TRUE(study.sky.time);
  EXPECT_TRUE(study.sky.isPerez);
  EXPECT_EQ(study.sky.time->day, 21);
  EXPECT_NEAR(study.sky.time->hour_h, 10.0 + 30.0 / 3600.0, 1e-12);
  EXPECT_EQ(study.sky.time->zone_h, -3.5);
  ASSERT_TRUE(study.sky.irradiance);
  EXPECT_EQ(study.sky.irradiance->diffuseHorizontal_W_m2, 90.0);
  const std::string text = studyToml(study);
  EXPECT_TRUE(contains(text, "time = 2026-03-21T10:00:30-03:30\n")) << text;
  Study again = readText(text);
  again.assumptions = study.assumptions;
  EXPECT_EQ(studyToml(again), text);
  EXPECT_FALSE(readText(kModel + "[sky]\ntime = 2026-03-21T10:00:00\n").sky.time->zone_h);
}

TEST(Study, NamesSkies) {
  EXPECT_EQ(readText(kModel + "[sky]\ntype = \"uniform\"\n").sky.cieType, 5);
  EXPECT_EQ(readText(kModel + "[sky]\ntype = \"cie-overcast\"\n").sky.cieType, 16);
  EXPECT_EQ(readText(kModel + "[sky]\ntype = \"cie-clear\"\nsun = {altitude=40,azimuth=90}\n").sky.cieType,
            12);
  EXPECT_EQ(readText(kModel + "[sky]\ntype = \"cie-3\"\n").sky.cieType, 3);
}

TEST(Study, ReadsPointsFiles) {
  const TempFolder folder;
  const auto pointsOf = [&](const std::string& text) {
    folder.write("p.txt", text);
    return readStudy(folder.write("s.toml", kModel + "[[grid]]\npoints = \"p.txt\"\n")).grids[0].points;
  };
  using Point = std::array<double, 6>;
  EXPECT_EQ(pointsOf("# c\n1 2 3 0 0 2\n\n4\t5 6 0 -1 0\n"),
            (std::vector<Point>{{1, 2, 3, 0, 0, 1}, {4, 5, 6, 0, -1, 0}}));
  EXPECT_EQ(pointsOf("grid,room,x_m,y_m,z_m,nx,ny,nz,e\n\"a, b\",r,1,2,3,1,0,0,9\n"),
            (std::vector<Point>{{1, 2, 3, 1, 0, 0}}));
  EXPECT_EQ(pointsOf("1,2,3\r\n"), (std::vector<Point>{{1, 2, 3, 0, 0, 1}}));
  EXPECT_TRUE(contains(inputErrorOf([&] { pointsOf("x,y,z\n1,2,x\n"); }), "p.txt:2:"));
  EXPECT_TRUE(contains(inputErrorOf([&] { pointsOf("x,y\n1,2\n"); }), "z_m"));
  EXPECT_TRUE(contains(inputErrorOf([&] { pointsOf("1 2 3 0 0 0\n"); }), "p.txt:1:"));
  EXPECT_TRUE(contains(inputErrorOf([&] { pointsOf("1 2 3 0 0\n"); }), "p.txt:1:"));
  EXPECT_TRUE(contains(inputErrorOf([&] { pointsOf("\n"); }), "no sensor point"));
}

TEST(Accuracy, ReadsWordsAndPerCent) {
  EXPECT_EQ(parseAccuracy("draft"), 0.10);
  EXPECT_EQ(parseAccuracy("standard"), 0.05);
  EXPECT_EQ(parseAccuracy("fine"), 0.02);
  EXPECT_EQ(parseAccuracy("2.5%"), 0.025);
  EXPECT_EQ(parseAccuracy(" 5 % "), 0.05);
  for (const char* bad : {"", "5", "%", "0.05%", "51%", "nan%", "best", "5%%"}) {
    EXPECT_FALSE(parseAccuracy(bad)) << bad;
  }
}

Scene sceneOf(const std::vector<std::string>& names) {
  Scene scene;
  for (const std::string& name : names) {
    scene.materials.push_back({.name = name});
  }
  return scene;
}

TEST(MaterialRules, LetLaterRulesWin) {
  Scene scene = sceneOf({"wall a", "wall b"});
  Study study;
  study.materials = {{"WALL*", glm::dvec3(0.4), {}, {}, {}}, {"wall b", glm::dvec3(0.6), {}, {}, {}}};
  applyMaterialRules(study, scene);
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.4));
  EXPECT_EQ(scene.materials[1].reflectance, glm::dvec3(0.6));
}

TEST(MaterialRules, MakeGlazingAndLight) {
  Scene scene = sceneOf({"glass", "lamp", "door"});
  scene.materials[2].glazing = scene.materials[2].transmittanceIsAssumed = true;
  Study study;
  study.materials = {{"glass", {}, glm::dvec3(0.65), 2, {}},
                     {"lamp", {}, {}, {}, glm::dvec3(3000)},
                     {"nothing", {}, {}, {}, {}}};
  applyMaterialRules(study, scene);
  EXPECT_TRUE(scene.materials[0].glazing);
  EXPECT_EQ(scene.materials[0].panes, 2);
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.0));
  EXPECT_EQ(scene.materials[1].exitance_lm_m2, glm::dvec3(3000));
  EXPECT_EQ(countOf(scene.diagnoses, "C150"), 1U);
  EXPECT_EQ(countOf(scene.diagnoses, "C152"), 1U);
  study.materials = {{"door", glm::dvec3(0.3), glm::dvec3(0.0), {}, {}}};
  applyMaterialRules(study, scene);
  EXPECT_FALSE(scene.materials[2].glazing);
  EXPECT_EQ(scene.materials[2].reflectance, glm::dvec3(0.3));
}

TEST(MaterialRules, NameWhatIsOutOfRange) {
  Scene scene = sceneOf({"wall"});
  Study study;
  study.materials = {{"wall", glm::dvec3(1.2), {}, {}, {}}};
  const std::string message = inputErrorOf([&] { applyMaterialRules(study, scene); });
  EXPECT_TRUE(contains(message, "[materials.\"wall\"] reflectance 1.2 is not below 1")) << message;
}

}  // namespace
}  // namespace clerestory
