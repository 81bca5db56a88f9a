// SPDX-License-Identifier: GPL-3.0-or-later
// Links as 8 bytes and the cache that holds them: nothing lost in packing, and never more bytes than allowed.
#include "linkcache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <thread>

#include "solved.hpp"

namespace clerestory {
namespace {

TEST(Link, PackedSpreadComesBackWithinHalfAStep) {
  Link link;
  for (int i = 0; i <= 3990; ++i) {
    const float value = static_cast<float>(i) / 1000.0F;
    link.spread = Link::packSpread(value);
    EXPECT_NEAR(link.spreadOverReceiver(), value, 0.5F / 16384.0F + 1e-6F);
    EXPECT_EQ(Link::packSpread(link.spreadOverReceiver()), link.spread);
  }
  link.spread = Link::packSpread(1e9F);  // what is wider is as wide as can be said
  EXPECT_NEAR(link.spreadOverReceiver(), 3.99F, 1e-4F);
}

TEST(LinkCache, GivesNoMorePlacesThanFit) {
  EXPECT_FALSE(LinkCache(0).keeps(1.0F, 0));
  EXPECT_FALSE(LinkCache(15).keeps(1.0F, 0));
  for (const std::size_t bytes : {std::size_t{16}, std::size_t{1000}, std::size_t{65536}}) {
    LinkCache cache(bytes);
    std::atomic<std::size_t> got{0};
    const auto take = [&] {
      for (std::size_t i = 0; i < bytes; ++i) got += cache.keeps(1.0F, i) ? 1 : 0;
    };
    std::thread other(take);
    take();
    other.join();
    EXPECT_EQ(got, bytes / sizeof(CachedLink));
    cache.replace({}, 0, 0.5F);
    EXPECT_TRUE(cache.keeps(100.0F, 0));  // the next step has its places again
  }
}

TEST(LinkCache, FindsTheLinksOfAReceiver) {
  LinkCache cache(1 << 16);
  std::vector<CachedLink> links;
  for (std::uint32_t i = 0; i < 500; ++i) {
    links.push_back({(i * 7) % 20, (i * 13) % 500, {static_cast<float>(i), 0, 0}});
  }
  cache.replace(links, 22, 1.0F);
  EXPECT_EQ(cache.size(), links.size());
  std::size_t found = 0;
  for (NodeIndex receiver = 0; receiver < 25; ++receiver) {
    const auto own = cache.ofReceiver(receiver);
    found += own.size();
    EXPECT_EQ(own.empty(), receiver >= 20);
    EXPECT_TRUE(std::is_sorted(own.begin(), own.end(),
                               [](const auto& a, const auto& b) { return a.sender < b.sender; }));
    for (const CachedLink& link : own) EXPECT_EQ(link.receiver, receiver);
  }
  EXPECT_EQ(found, links.size());
}

// Steps that are alike but for their fading light: those links are kept that carry most, and nearly as many
// as fit.
TEST(LinkCache, KeepsTheCostliestThatFit) {
  constexpr std::size_t places = 100;
  for (const float fade : {1.0F, 0.25F}) {
    LinkCache cache(places * sizeof(CachedLink));
    float light = 1.0F;
    for (int step = 0; step < 4; ++step) {
      std::vector<int> kept;
      // The weakest come first: without a threshold they would take all places.
      for (int i = 999; i >= 0; --i) {
        if (cache.keeps(light * std::exp2(-20.0F * static_cast<float>(i) / 1000.0F),
                        static_cast<std::uint64_t>(i)))
          kept.push_back(i);
      }
      ASSERT_LE(kept.size(), places);
      if (step > 0) {
        // Whole classes of an eighth octave are taken, here up to 7 links each.
        EXPECT_GE(kept.size(), places - 7);
        EXPECT_LT(kept.front(), static_cast<int>(places));
      }
      cache.replace({}, 0, fade);
      light *= fade;
    }
  }
}

// The whole solve keeps to the budget in every step, gives the same light with any, and uses what it kept.
TEST(LinkCache, SolveKeepsToTheBudget) {
  Study study;
  study.grids = {drawn::gridOf({{1.8, 2.0, 0.85}, {1.8, 6.0, 0.85}})};
  const Building building = drawn::buildingOf(testModel("reference/refoffice/refoffice.obj", study), study);
  std::vector<double> before;
  for (const std::size_t bytes :
       {std::size_t{0}, std::size_t{1} << 12, std::size_t{1} << 16, std::size_t{1} << 30}) {
    SolveOptions options;
    options.linkCacheBytes = bytes;
    options.pictures = false;
    const Solution solution = solve(building, study, options);
    std::uint64_t reused = 0;
    for (const IterationStatistics& row : solution.iterations) {
      EXPECT_LE(row.linksCached * sizeof(CachedLink), bytes);
      EXPECT_LE(row.linksReused, row.linksCached) << "step " << row.iteration;  // what the step began with
      reused += row.linksReused;
    }
    EXPECT_EQ(reused > 0, bytes > 0) << bytes << " bytes";
    std::vector<double> values;
    for (const SensorValue& sensor : solution.grids[0].sensors) values.push_back(sensor.illuminance_lx);
    if (!before.empty()) {
      EXPECT_EQ(values, before) << bytes << " bytes";
    }
    before = values;
  }
}

}  // namespace
}  // namespace clerestory
