// SPDX-License-Identifier: GPL-3.0-or-later
// The page and study.json: harmless whatever names say, complete in themselves, the same bytes every time.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

#include "fake.hpp"

namespace clerestory {
namespace {

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
    ++count;
  return count;
}

std::string page(const fake::Case& made) {
  const fake::TemporaryFolder folder;
  writeReport(folder.path() / "report", made.input());
  return fake::contentOf(folder.path() / "report" / "index.html");
}

/// The page with no picture data in it, where any letters may follow each other.
std::string withoutPictures(std::string html) {
  const std::string start = "data:image/png;base64,";
  for (std::size_t at = html.find(start); at != std::string::npos; at = html.find(start, at + 1)) {
    html.erase(at, html.find('"', at) - at);
  }
  return html;
}

/// The page with nothing in its own script elements but their tags.
std::string withoutScripts(std::string html) {
  for (std::size_t at = html.find("<script"); at != std::string::npos; at = html.find("<script", at + 1)) {
    const std::size_t start = html.find('>', at) + 1;
    html.erase(start, html.find("</script>", start) - start);
  }
  return html;
}

/// The scripts that run, in the page's order: elements without a type.
std::vector<std::string> scriptsOf(const std::string& html) {
  std::vector<std::string> scripts;
  const std::string start = "<script>";
  for (std::size_t at = html.find(start); at != std::string::npos; at = html.find(start, at + 1)) {
    scripts.push_back(html.substr(at + start.size(), html.find("</script>", at) - at - start.size()));
  }
  return scripts;
}

TEST(Page, EscapesEveryNameFromTheModel) {
  const std::string attack = "\"'><script>alert(1)</script>&";
  fake::Case made = fake::office();
  made.study.modelFileAsWritten = attack + ".obj";
  made.study.views[0].name = made.building.grids[0].name = made.building.rooms[0].name = attack;
  made.study.assumptions.push_back(attack);
  for (Material& material : made.building.model.materials) material.name = attack;
  for (Surface& surface : made.building.model.surfaces) surface.name = attack;
  made.diagnoses.push_back({attack, attack, attack, 1});
  const std::string whole = page(made);
  EXPECT_EQ(scriptsOf(whole), scriptsOf(page(fake::office())));
  const std::string html = withoutScripts(whole);
  EXPECT_EQ(countOf(html, "<script"), countOf(whole, "</script>"));
  EXPECT_EQ(html.find("alert(1)</"), std::string::npos);
  EXPECT_GT(countOf(html, "&lt;script&gt;alert(1)&lt;/script&gt;&amp;"), 10u);
}

TEST(Page, NeedsNothingFromOutside) {
  const std::string html = withoutScripts(withoutPictures(page(fake::office())));
  std::string lower = html;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  // The policy's own http-equiv is the only place where these letters may stand.
  EXPECT_EQ(countOf(lower, "http"), countOf(lower, "http-equiv"));
  for (const char* part : {"<script src", "<link", "@import", "url(//", "src=\"//", "<iframe", "onload="}) {
    EXPECT_EQ(lower.find(part), std::string::npos) << part;
  }
  EXPECT_NE(
      html.find("content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; "
                "form-action 'none'; script-src 'sha256-"),
      std::string::npos);
}

TEST(Page, RunsItsOwnScriptsAndNoOthers) {
  const std::string html = page(fake::office());
  const std::vector<std::string> scripts = scriptsOf(html);
  ASSERT_GE(scripts.size(), 1u);
  EXPECT_LE(scripts.size(), 2u);
  const std::size_t policy = html.find("script-src ");
  const std::string allowed = html.substr(policy, html.find('"', policy) - policy);
  EXPECT_EQ(countOf(allowed, "'sha256-"), scripts.size());
  EXPECT_EQ(allowed.find("unsafe"), std::string::npos);
  for (const std::string& script : scripts) EXPECT_EQ(script.find("<!--"), std::string::npos);
}

TEST(Page, ShowsEverySensorRoomAndView) {
  const fake::Case made = fake::office();
  const std::string html = page(made);
  std::size_t sensors = 0;
  for (const SensorGrid& grid : made.building.grids) sensors += grid.points.size();
  EXPECT_EQ(countOf(html, "</title></rect>"), sensors);
  EXPECT_EQ(countOf(html, "<img src=\"data:image/png;base64,"),
            3u);  // the view, its luminance and illuminance
  for (const char* text :
       {">Office</h2>", ">Store</h2>", "G203", "0.1.0", "white paint", "Median daylight factor"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
}

/// The page up to its first section: what a reader sees before scrolling.
std::string firstScreenOf(const fake::Case& made) {
  const std::string html = withoutPictures(page(made));
  return html.substr(0, html.find("<section"));
}

// 60 of 100 sensors have 5 % and 35 have 2 % of 10,000 lx. For 16,000 lx the norm asks 1.875 % and 0.625 %
// (minimum), 3.125 % and 1.875 % (medium), 4.6875 % and 3.125 % (high).
TEST(Page, FirstScreenJudgesTheOneGrid) {
  fake::Case made = fake::office();
  made.study.sky = {};
  made.study.sky.cieType = 16;
  made.study.sky.diffuseHorizontal_lx = 10000.0;
  made.study.site.externalDiffuse_lx = 16000.0;
  made.building.grids.resize(1);
  made.solution.grids.resize(1);
  made.building.grids[0].points.assign(100, glm::dvec3(0.0));
  made.building.grids[0].normals.assign(100, glm::dvec3(0.0, 0.0, 1.0));
  std::vector<SensorValue>& sensors = made.solution.grids[0].sensors;
  sensors.assign(100, {});
  for (std::size_t i = 0; i < 100; ++i)
    sensors[i].illuminance_lx = sensors[i].sky_lx = i < 60 ? 500.0 : i < 95 ? 200.0 : 20.0;
  const std::string first = firstScreenOf(made);
  for (const char* text :
       {"met, medium", "3.1\u00a0% on half of the area (here on 60\u00a0%)",
        "1.9\u00a0% on 95\u00a0% of it (here on 95\u00a0%)", "<dt>Mean illuminance</dt><dd>371 ",
        "<dt>Minimum illuminance</dt><dd>20 ", "<dd>0.05</dd>"}) {
    EXPECT_NE(first.find(text), std::string::npos) << text;
  }
}

TEST(Page, FirstScreenSaysWhyNothingIsJudged) {
  fake::Case made = fake::office();
  made.study.sky = {};
  made.study.sky.cieType = 12;
  made.study.sky.sun_deg = glm::dvec2(40.0, 180.0);
  EXPECT_NE(firstScreenOf(made).find("is not judged: its daylight factors are those of an overcast sky"),
            std::string::npos);
}

// Of five volumes of air two were solved, one with a room is lit but asked for by nothing, two are dark.
TEST(Page, TellsWhatWasModelledAndWhatWasNot) {
  fake::Case made = fake::office();
  made.building.domains.resize(5);
  made.building.rooms.push_back(made.building.rooms.back());
  made.building.rooms.back().name = "Flat <next> door";
  made.building.rooms.back().domain = 2;
  for (std::size_t d = 0; d < 3; ++d) made.building.domains[d].lit = true;
  std::size_t figures = made.solution.surfaces.size();
  for (const GridValues& grid : made.solution.grids) figures += grid.sensors.size();
  const std::string html = page(made);
  EXPECT_NE(html.find("96 faces were read; 22 planar polygons"), std::string::npos);
  EXPECT_NE(html.find(" for each of the " + std::to_string(figures) + " figures"), std::string::npos);
  EXPECT_NE(html.find("Volumes of air left out: 2 that no light reaches, 1 that nothing asks for, with Flat "
                      "&lt;next&gt; door."),
            std::string::npos);
}

TEST(Page, ClosesWhatItOpens) {
  const std::string html = withoutScripts(page(fake::office()));
  for (const char* tag :
       {"table", "section", "figure", "svg", "g", "dl", "ul", "div", "p", "title", "main"}) {
    const std::string name = tag;
    EXPECT_EQ(countOf(html, "<" + name + ">") + countOf(html, "<" + name + " "),
              countOf(html, "</" + name + ">"))
        << tag;
  }
}

TEST(Page, LivesWithAnEmptyStudy) {
  fake::Case made = fake::office();
  made.building.grids.clear();
  made.building.rooms.clear();
  made.solution = {};
  EXPECT_NE(page(made).find("</html>"), std::string::npos);
}

TEST(StudyJson, IsTheSameForAnotherRunAndFolder) {
  const fake::Case made = fake::office();
  const std::string first = studyJson(made.input());
  fake::Case elsewhere = fake::office();
  elsewhere.study.modelFile = "/other/folder/office.obj";
  elsewhere.study.modelFileAsWritten = "/other/folder/office.obj";
  for (IterationStatistics& step : elsewhere.solution.iterations) step.linksCached = step.linksReused = 7;
  ReportInput other = elsewhere.input();
  other.run.threads = 16;
  other.run.linkCacheBytes = 1;
  other.run.stageSeconds = {{"solve", 99.0}};
  other.run.commandLine = "clerestory study /other/folder/office.obj";
  EXPECT_EQ(studyJson(other), first);
  EXPECT_EQ(first.find("/other"), std::string::npos);
  EXPECT_EQ(first.find("/nowhere"), std::string::npos);
}

TEST(StudyJson, HidesFoldersInDiagnoses) {
  fake::Case made = fake::office();
  made.diagnoses = {{"C101", "cannot read", "/nowhere/that/exists/office.mtl:12", 1}};
  const auto json = nlohmann::json::parse(studyJson(made.input()));
  EXPECT_EQ(json["diagnoses"][0]["where"], "office.mtl:12");
}

TEST(StudyJson, CarriesChecksumMetricsAndBalances) {
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  made.study.modelFile = folder.path() / "abc.obj";
  std::ofstream(made.study.modelFile, std::ios::binary) << "abc";
  const auto json = nlohmann::json::parse(studyJson(made.input()));
  EXPECT_EQ(json["inputs"]["model"]["sha256"],
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(json["version"], "0.1.0");
  EXPECT_EQ(json["rooms"].size(), 2u);
  EXPECT_EQ(json["rooms"][0]["grids"][0]["sensors"], made.building.grids[0].points.size());
  EXPECT_EQ(json["surfaces"].size(), made.solution.surfaces.size());
  EXPECT_NEAR(json["energy_balance"][0]["emitted_lm"].get<double>(), 8412.7, 1e-3);
  EXPECT_EQ(json["cleanup"]["faces_read"], 96);
}

TEST(StudyJson, ChecksumsOfLongAndAwkwardLengths) {
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  made.study.modelFile = folder.path() / "a.obj";
  // From FIPS 180-4's examples, and one million times "a".
  const std::vector<std::pair<std::string, std::string>> known = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
       "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {std::string(1'000'000, 'a'), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"}};
  for (const auto& [content, checksum] : known) {
    std::ofstream(made.study.modelFile, std::ios::binary) << content;
    EXPECT_EQ(nlohmann::json::parse(studyJson(made.input()))["inputs"]["model"]["sha256"], checksum);
  }
}

}  // namespace
}  // namespace clerestory
