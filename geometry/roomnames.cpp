// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for beginnings of objects' names that one room has for itself, and for floors named for their room.
#include "roomnames.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace clerestory {
namespace {

constexpr double mostOfTheRoom = 0.5;  // of its surface: furniture has names of its own
constexpr double littleOfOthers =
    1.0 / 3.0;  // a wall or floor between two rooms bears the name of one of them
constexpr double mostOfTheFloor = 0.8;

constexpr auto roomWords = std::to_array<std::string_view>(
    {"bedroom", "bathroom", "livingroom", "kitchen",    "bath",         "office",       "hall",
     "hallway", "corridor", "lobby",      "toilet",     "wc",           "attic",        "studio",
     "storage", "lounge",   "classroom",  "bad",        "küche",        "kueche",       "büro",
     "buero",   "flur",     "diele",      "wohnzimmer", "schlafzimmer", "kinderzimmer", "keller",
     "cuisine", "bureau",   "salon",      "couloir",    "cocina",       "baño",         "dormitorio",
     "oficina", "pasillo",  "cucina",     "bagno",      "camera",       "ufficio",      "corridoio",
     "keuken",  "badkamer", "slaapkamer", "woonkamer",  "kantoor",      "gang",         "kök",
     "sovrum"});
/// These alone, with a number, are what programs call rooms that nobody has named.
constexpr auto vagueWords = std::to_array<std::string_view>(
    {"room", "zimmer", "raum", "chambre", "salle", "sala", "kamer", "rum", "floor", "space", "zone"});

bool isSeparator(char c) {
  return c == '_' || c == ' ' || c == '.' || c == '-' || c == ':' || c == '/';
}

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & '\x80') != 0;
}

/// Beginnings of a name that end before a separator or before a word that begins with a capital
/// ("AtticFace1").
std::vector<std::string> beginningsOf(const std::string& name) {
  std::vector<std::string> beginnings;
  for (std::size_t i = 1; i < name.size(); ++i) {
    const bool isHump = name[i] >= 'A' && name[i] <= 'Z' && name[i - 1] >= 'a' && name[i - 1] <= 'z';
    if ((isSeparator(name[i]) && !isSeparator(name[i - 1])) || isHump)
      beginnings.push_back(name.substr(0, i));
  }
  beginnings.push_back(name);
  return beginnings;
}

/// Whether it could be a name: three letters in a row at least.
bool isWord(const std::string& text) {
  std::size_t run = 0;
  for (const char c : text) {
    run = isLetter(c) ? run + 1 : 0;
    if (run == 3) return true;
  }
  return false;
}

std::vector<std::string> wordsOf(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    const bool isCapital = c >= 'A' && c <= 'Z';
    if ((!isLetter(c) || isCapital) && !words.back().empty()) words.emplace_back();
    if (isLetter(c)) words.back() += isCapital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return words;
}

/// Whether it says which room it is: "Kitchen floor", "Meeting room", but not "Room_17".
bool namesARoom(const std::string& name) {
  const std::vector<std::string> words = wordsOf(name);
  const auto holds = [&](const auto& list) {
    return std::ranges::any_of(
        words, [&](const std::string& word) { return std::ranges::find(list, word) != list.end(); });
  };
  const bool saysMore = std::ranges::any_of(words, [](const std::string& word) {
    return word.size() >= 3 && std::ranges::find(vagueWords, word) == vagueWords.end();
  });
  return holds(roomWords) ||
         (holds(std::array{std::string_view("room"), std::string_view("zimmer")}) && saysMore);
}

/// The surface of each room, and how much of it objects with each beginning draw. [m²]
struct RoomSurface {
  double area_m2 = 0.0;
  std::map<std::string, double> byBeginning_m2;
};

std::vector<RoomSurface> surfacesOf(const Building& building) {
  const Pieces& pieces = building.model.pieces;
  std::vector<std::map<std::uint32_t, double>> bySurface_m2(building.rooms.size());
  for (std::uint32_t side = 0; side < building.sideRoom.size(); ++side) {
    const std::int32_t room = building.sideRoom[side];
    if (room < 0) continue;
    bySurface_m2[static_cast<std::size_t>(room)][pieces.surface[side / 2]] += pieces.area_m2[side / 2];
  }
  std::vector<RoomSurface> result(building.rooms.size());
  for (std::size_t room = 0; room < result.size(); ++room) {
    for (const auto& [surface, area_m2] : bySurface_m2[room]) {
      result[room].area_m2 += area_m2;
      for (const std::string& beginning : beginningsOf(building.model.surfaces[surface].name))
        result[room].byBeginning_m2[beginning] += area_m2;
    }
  }
  return result;
}

/// The longest beginning that is the room's own; empty where there is none.
std::string ownBeginning(const std::vector<RoomSurface>& surfaces, std::size_t room) {
  std::string best;
  for (const auto& [beginning, area_m2] : surfaces[room].byBeginning_m2) {
    if (area_m2 < mostOfTheRoom * surfaces[room].area_m2 || beginning.size() < best.size() ||
        !isWord(beginning))
      continue;
    bool isOwn = true;
    for (std::size_t other = 0; other < surfaces.size() && isOwn; ++other) {
      if (other == room) continue;
      const auto found = surfaces[other].byBeginning_m2.find(beginning);
      isOwn = found == surfaces[other].byBeginning_m2.end() ||
              found->second < littleOfOthers * surfaces[other].area_m2;
    }
    if (isOwn) best = beginning;
  }
  return best;
}

/// Names of objects that are the floor of one room alone and hold a word for a room; empty for other rooms.
std::vector<std::string> namesByFloor(const Building& building) {
  const Pieces& pieces = building.model.pieces;
  std::map<std::string, std::map<std::size_t, double>> floor_m2;  // by object and room
  for (std::size_t room = 0; room < building.rooms.size(); ++room) {
    for (const std::uint32_t piece : building.rooms[room].floorPieces)
      floor_m2[building.model.surfaces[pieces.surface[piece]].name][room] += pieces.area_m2[piece];
  }
  std::vector<std::string> names(building.rooms.size());
  for (const auto& [object, rooms] : floor_m2) {
    if (rooms.size() != 1 || !namesARoom(object)) continue;
    const auto& [room, area_m2] = *rooms.begin();
    if (area_m2 >= mostOfTheFloor * building.rooms[room].floorArea_m2) names[room] = object;
  }
  return names;
}

}  // namespace

void nameRooms(Building& building) {
  std::vector<std::string> names = namesByFloor(building);
  if (building.rooms.size() > 1) {  // all of a single room's objects are its own
    const std::vector<RoomSurface> surfaces = surfacesOf(building);
    for (std::size_t room = 0; room < names.size(); ++room) {
      const std::string own = ownBeginning(surfaces, room);
      if (!own.empty()) names[room] = own;
    }
  }
  for (std::size_t room = 0; room < names.size(); ++room) {
    if (!names[room].empty() && std::count(names.begin(), names.end(), names[room]) == 1)
      building.rooms[room].name = names[room];
  }
}

}  // namespace clerestory
