#include <engine/golden.h>
#include <gtest/gtest.h>

TEST(Golden, PicturesAreAsRecordedBitForBit) {
    const still::golden::Verdict verdict = still::golden::verify("golden");
    EXPECT_TRUE(verdict.ok) << verdict.message;
}
