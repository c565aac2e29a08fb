#include "limber/core/grouped.h"

#include <gmock/gmock.h>

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Grouped, GroupsKeepTheOrderOfTheirItems) {
  const Grouped<char> letters(4, [](const auto& visit) {
    visit(3, 'd');
    visit(0, 'b');
    visit(3, 'a');
    visit(0, 'c');
  });
  EXPECT_EQ(letters.count(), 4u);
  EXPECT_THAT(letters.of(0), ElementsAre('b', 'c'));
  EXPECT_THAT(letters.of(1), IsEmpty());
  EXPECT_THAT(letters.of(2), IsEmpty());
  EXPECT_THAT(letters.of(3), ElementsAre('d', 'a'));
  EXPECT_THAT(letters.items(), ElementsAre('b', 'c', 'd', 'a'));
}

TEST(Grouped, NumbersAscendInEachGroup) {
  const Grouped<Index> numbers = numbersByGroup(std::vector<Index>{2, 0, 2, 0}, 3);
  EXPECT_THAT(numbers.of(0), ElementsAre(1, 3));
  EXPECT_THAT(numbers.of(1), IsEmpty());
  EXPECT_THAT(numbers.of(2), ElementsAre(0, 2));
}

TEST(Grouped, ThereMayBeNoGroup) {
  EXPECT_EQ(Grouped<Index>().count(), 0u);
  EXPECT_EQ(numbersByGroup({}, 0).count(), 0u);
  EXPECT_THAT(numbersByGroup({}, 2).of(1), IsEmpty());
}

}  // namespace
}  // namespace limber
