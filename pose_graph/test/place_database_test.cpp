#include "pose_graph/place/place_database.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

constexpr std::size_t kWords = 500;

BagOfWords randomBag(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::set<std::uint32_t> words;
  while (words.size() < 40) words.insert(static_cast<std::uint32_t>(random() % kWords));
  BagOfWords bag;
  double sum = 0.0;
  for (const std::uint32_t word : words) {
    bag.push_back({word, 1.0F + static_cast<float>(random() % 5)});
    sum += bag.back().weight;
  }
  for (auto& entry : bag) entry.weight = static_cast<float>(entry.weight / sum);
  return bag;
}

PlaceDatabase databaseOf(const std::set<std::int64_t>& ids) {
  PlaceDatabase database(kWords);
  for (const std::int64_t id : ids) database.add(id, randomBag(static_cast<std::uint64_t>(id)));
  return database;
}

void expectEqual(const std::vector<PlaceScore>& a, const std::vector<PlaceScore>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].score, b[i].score);
  }
}

TEST(PlaceDatabase, ScoresAsBagsDo) {
  const PlaceDatabase database = databaseOf({3, 10, 11, 500, 501});
  const BagOfWords query = randomBag(10);
  const auto results = database.query(query, 10);
  ASSERT_FALSE(results.empty());
  EXPECT_EQ(results[0].id, 10);
  // The weights' sum, in float.
  EXPECT_NEAR(results[0].score, 1.0, 1e-5);
  for (const PlaceScore& result : results) {
    EXPECT_DOUBLE_EQ(result.score,
                     bagScore(query, randomBag(static_cast<std::uint64_t>(result.id))));
  }
  for (std::size_t i = 1; i < results.size(); ++i) {
    EXPECT_LE(results[i].score, results[i - 1].score);
  }
}

TEST(PlaceDatabase, KeepsToTheLimits) {
  const PlaceDatabase database = databaseOf({1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(database.query(randomBag(7), 3).size(), 3u);
  EXPECT_TRUE(database.query(randomBag(7), 0).empty());
  for (const PlaceScore& result : database.query(randomBag(7), 10, 4)) EXPECT_LT(result.id, 4);
  EXPECT_FALSE(database.query(randomBag(7), 10, 4).empty());
  EXPECT_TRUE(database.query({}, 10).empty());
}

TEST(PlaceDatabase, ForgetsAsIfAPlaceHadNeverBeen) {
  PlaceDatabase database = databaseOf({1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_TRUE(database.remove(3));
  EXPECT_TRUE(database.remove(7));
  EXPECT_FALSE(database.remove(7));
  EXPECT_FALSE(database.contains(7));
  database.add(9, randomBag(9));
  const std::set<std::int64_t> left{1, 2, 4, 5, 6, 8, 9};
  EXPECT_EQ(database.ids(), std::vector<std::int64_t>(left.begin(), left.end()));
  for (const std::uint64_t seed : {3U, 7U, 9U, 100U}) {
    expectEqual(database.query(randomBag(seed), 20), databaseOf(left).query(randomBag(seed), 20));
  }
}

TEST(PlaceDatabase, TheLowestIdComesFirstAmongEquals) {
  PlaceDatabase database(kWords);
  for (const std::int64_t id : {30, 10, 20}) database.add(id, randomBag(1));
  const auto results = database.query(randomBag(1), 2);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].id, 10);
  EXPECT_EQ(results[1].id, 20);
}

TEST(PlaceDatabase, RefusesWhatDoesNotFit) {
  PlaceDatabase database = databaseOf({1});
  EXPECT_THROW(database.add(1, {}), InputError);
  EXPECT_THROW(database.add(2, {{kWords, 1.0F}}), InputError);
  EXPECT_EQ(database.size(), 1u);
}

}  // namespace
}  // namespace vins::pose_graph
