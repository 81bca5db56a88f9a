// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms and panes of models that others made; built only where CLERESTORY_MODELS says where these are.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <geometry/faults.hpp>

#include "howeverdrawn.hpp"

namespace clerestory {
namespace {

/// With units and axis guessed.
Building buildingOfModel(const std::string& file) {
  return drawn::buildingOf(readModel(std::string(CLERESTORY_MODELS) + "/" + file, {}));
}

/// Rooms' floor areas by size.
std::vector<double> floorsOf(const Building& building) {
  std::vector<double> floors_m2;
  for (const Room& room : building.rooms) floors_m2.push_back(room.floorArea_m2);
  std::sort(floors_m2.begin(), floors_m2.end());
  return floors_m2;
}

/// `expected_m2`: floors as drawn, by size. The parts of a floor below doors may go to either room.
void expectRooms(const Building& building, const std::vector<double>& expected_m2, std::size_t panes) {
  const std::vector<double> floors_m2 = floorsOf(building);
  ASSERT_EQ(floors_m2.size(), expected_m2.size());
  for (std::size_t i = 0; i < expected_m2.size(); ++i) EXPECT_NEAR(floors_m2[i], expected_m2[i], 0.3);
  EXPECT_EQ(building.portals.size(), panes);
  for (const Portal& portal : building.portals) EXPECT_GE(portal.room, 0);
}

// Its fifth room is a balcony, outdoors.
TEST(FurtherModels, StudioShellHasFourRooms) {
  expectRooms(buildingOfModel("room-sh3d-Studio/Studio_shell.obj"), {2.72, 4.30, 8.25, 12.00}, 5);
}

// A wardrobe of 1 m² reaches the ceiling.
TEST(FurtherModels, FurnishedStudioHasFourRooms) {
  expectRooms(buildingOfModel("room-sh3d-Studio/Studio.obj"), {2.72, 4.30, 8.25, 11.0}, 5);
}

TEST(FurtherModels, ApartmentHasSevenRooms) {
  expectRooms(buildingOfModel("room-sh3d-2BedroomApartment/2BedroomApartment_shell.obj"),
              {1.11, 4.83, 9.77, 9.98, 10.61, 10.91, 16.02}, 10);
  // Furnished, sliding doors close a cupboard of 1.45 x 0.57 m off the corridor's 9.98 m².
  expectRooms(buildingOfModel("room-sh3d-2BedroomApartment/2BedroomApartment.obj"),
              {1.11, 4.83, 9.98 - 1.45 * 0.57, 9.77, 10.61, 10.91, 16.02}, 10);
}

TEST(FurtherModels, HoneybeeHouseAndOffice) {
  expectRooms(buildingOfModel("room-honeybee/single_family_home.obj"),
              {14.25, 16.0, 16.0, 16.62, 16.63, 18.2, 47.35}, 8);
  const Building office = buildingOfModel("room-honeybee/model_complete_multi_zone_office.obj");
  expectRooms(office, {100.0, 100.0, 100.0}, 8);
  ASSERT_EQ(office.rooms.size(), 3U);
  EXPECT_EQ(office.rooms[0].name, "First_Floor");
  EXPECT_EQ(office.rooms[1].name, "Second_Floor");
  EXPECT_EQ(office.rooms[2].name, "Attic");
}

TEST(FurtherModels, OpenPlanOfficeAndTutorialRoomAreOneRoom) {
  expectRooms(buildingOfModel("room-lbnl-openplan/frads_openplan.obj"), {170.96}, 8);
  expectRooms(buildingOfModel("room-radiance-tutorial/rt_room.obj"), {37.16}, 1);
}

class RedrawnModels : public testing::TestWithParam<const char*> {};

TEST_P(RedrawnModels, AreTheSameHoweverTheyAreDrawn) {
  const std::filesystem::path file = std::filesystem::path(CLERESTORY_MODELS) / GetParam();
  drawn::expectSameHoweverDrawn(file);
}

INSTANTIATE_TEST_SUITE_P(Of, RedrawnModels,
                         testing::Values("room-honeybee/single_family_home.obj",
                                         "room-honeybee/model_complete_multi_zone_office.obj",
                                         "room-radiance-tutorial/rt_room.obj",
                                         "room-lbnl-openplan/frads_openplan.obj",
                                         "room-sh3d-Studio/Studio_shell.obj", "room-sh3d-Studio/Studio.obj",
                                         "room-sh3d-2BedroomApartment/2BedroomApartment_shell.obj",
                                         "room-sh3d-2BedroomApartment/2BedroomApartment.obj",
                                         "room-duplex-ifc/duplex_webifc.obj"),
                         [](const auto& test) { return std::filesystem::path(test.param).stem().string(); });

// Two dwellings of seven rooms each: all panes serve one of them.
TEST(FurtherModels, DuplexHasFourteenRooms) {
  const Building building = buildingOfModel("room-duplex-ifc/duplex_webifc.obj");
  EXPECT_EQ(building.rooms.size(), 14U);
  EXPECT_EQ(building.portals.size(), 24U);
  for (const Portal& portal : building.portals) EXPECT_GE(portal.room, 0);
}

// What comes with the models, and where it is counted otherwise here: docs/diagnoses.md says why.
TEST(FurtherModels, FaultsAreCountedAlike) {
  const auto faultsOf = [](const std::string& file) {
    return countFaults(readModel(std::string(CLERESTORY_MODELS) + "/" + file, {}));
  };
  const DrawnFaults studio = faultsOf("room-sh3d-Studio/Studio.obj");
  EXPECT_EQ(studio.repeatedFaces, 63U);
  EXPECT_EQ(studio.facesWithoutArea, 125U);
  EXPECT_NEAR(static_cast<double>(studio.nonManifoldEdges), 4338.0, 0.01 * 4338.0);
  const DrawnFaults apartment = faultsOf("room-sh3d-2BedroomApartment/2BedroomApartment.obj");
  EXPECT_EQ(apartment.repeatedFaces, 160U - 4U);
  const DrawnFaults duplex = faultsOf("room-duplex-ifc/duplex_webifc.obj");
  EXPECT_EQ(duplex.repeatedPoints, 47122U);
  EXPECT_EQ(duplex.edgesWoundApart, 4409U);
  const DrawnFaults office = faultsOf("room-lbnl-openplan/frads_openplan.obj");
  EXPECT_EQ(office.repeatedPoints, 35148U);
  EXPECT_EQ(office.edgesWoundApart, 843U);
  const DrawnFaults hotel = faultsOf("room-hotel-glb/hotel-room.glb");
  EXPECT_EQ(hotel.facesWithoutArea, 8U);
  EXPECT_EQ(hotel.nonManifoldEdges, 4919U - 4U);
}

// All panes that light crosses are two sheets in the flats and the duplex, one in the others.
TEST(FurtherModels, MaterialsUnitsAndSheetsAreAsStated) {
  struct Stated {
    const char *file, *units, *up;
    std::size_t materials;
    bool hasDoublePanes;
  };
  for (const Stated& stated :
       {Stated{"room-sh3d-Studio/Studio.obj", "cm", "y", 55, true},
        Stated{"room-sh3d-2BedroomApartment/2BedroomApartment.obj", "cm", "y", 101, true},
        Stated{"room-duplex-ifc/duplex_webifc.obj", "m", "y", 17, true},
        Stated{"room-hotel-glb/hotel-room.glb", "mm", "y", 11, false},
        Stated{"room-lbnl-openplan/frads_openplan.obj", "m", "z", 12, false},
        Stated{"room-honeybee/single_family_home.obj", "m", "z", 6, false}}) {
    SCOPED_TRACE(stated.file);
    const Scene scene = readModel(std::string(CLERESTORY_MODELS) + "/" + stated.file, {});
    EXPECT_EQ(scene.axes.units, stated.units);
    EXPECT_EQ(scene.axes.upAxis, stated.up);
    EXPECT_EQ(scene.materials.size(), stated.materials);
    EXPECT_EQ(cleanScene(scene).counts.paneSheetsDropped > 0, stated.hasDoublePanes);
  }
}

// Not from what the files say of themselves at their head.
TEST(FurtherModels, UpAxisFollowsFromTheGeometry) {
  const TempFolder folder;
  for (const auto& [file, axis] : std::vector<std::pair<std::string, std::string>>{
           {"room-sh3d-Studio/Studio_shell.obj", "y"},
           {"room-sh3d-Studio/Studio.obj", "y"},
           {"room-sh3d-2BedroomApartment/2BedroomApartment_shell.obj", "y"},
           {"room-sh3d-2BedroomApartment/2BedroomApartment.obj", "y"},
           {"room-duplex-ifc/duplex_webifc.obj", "y"},
           {"room-duplex-ifc/duplex_assimp_ngons.obj", "y"},
           {"room-honeybee/single_family_home.obj", "z"},
           {"room-honeybee/model_complete_multi_zone_office.obj", "z"},
           {"room-lbnl-openplan/frads_openplan.obj", "z"},
           {"room-radiance-tutorial/rt_room.obj", "z"}}) {
    std::ifstream whole(std::string(CLERESTORY_MODELS) + "/" + file);
    std::string text;
    for (std::string line; std::getline(whole, line);) text += line.starts_with('#') ? "\n" : line + '\n';
    EXPECT_EQ(readModel(folder.write("headless.obj", text), {}).axes.upAxis, axis) << file;
  }
}

}  // namespace
}  // namespace clerestory
