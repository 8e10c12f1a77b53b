// The store: schema, migration, two programs at once, what cannot be written.

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "calot/base/error.h"
#include "calot/training/questionnaire.h"
#include "calot/training/store.h"
#include "calot/training/study.h"
#include "setups.h"

namespace calot::training {
namespace {

SessionRow finished(Store& store, const std::string& trainee, double points) {
    SessionLock lock;
    SessionRow row;
    row.trainee = trainee;
    row.scene = "scene";
    row.task = "dissect";
    row.seed = 18'000'000'000'000'000'000ull;
    row.id = store.begin(row, lock);
    row.status = SessionStatus::finished;
    row.points = points;
    row.duration_s = 12.5;
    row.metrics = {{"time_s", 12.5}, {"hook_smoothness", std::nan("")}};
    store.finish(row);
    return row;
}

TEST(Store, KeepsWhatItIsGiven) {
    const test::TestFolder folder("store");
    {
        Store store(folder.path());
        EXPECT_TRUE(store.sessions().empty());
        finished(store, "Ä \"quoted\", with comma", 71.25);
        store.answer(1, {5, 4, std::nullopt}, "good");
    }
    Store store(folder.path());
    const SessionRow row = store.session(1);
    EXPECT_EQ(row.trainee, "Ä \"quoted\", with comma");
    EXPECT_EQ(row.seed, 18'000'000'000'000'000'000ull);
    EXPECT_EQ(row.status, SessionStatus::finished);
    EXPECT_DOUBLE_EQ(*row.points, 71.25);
    EXPECT_EQ(row.metrics.size(), 1u);  // what is not known is not told
    ASSERT_EQ(row.answers.size(), 3u);
    EXPECT_EQ(row.answers[0], 5);
    EXPECT_FALSE(row.answers[2]);
    EXPECT_EQ(row.remark, "good");
    EXPECT_THROW(store.session(2), InputError);
    EXPECT_THROW(store.answer(2, {1}, ""), InputError);
    EXPECT_NE(csv(store.sessions()).find("\"Ä \"\"quoted\"\", with comma\""), std::string::npos);
}

TEST(Store, TakesAnOlderDatabaseAlong) {
    const test::TestFolder folder("store_old");
    {
        Store store(folder.path());
        finished(store, "A", 50.0);
    }
    {
        // Back to the first schema, as an older program left it.
        Database database(folder.path() + "/calot.sqlite");
        database.execute("ALTER TABLE session DROP COLUMN remark");
        database.execute("PRAGMA user_version = 1");
    }
    Store store(folder.path());
    EXPECT_DOUBLE_EQ(*store.session(1).points, 50.0);
    store.answer(1, {3}, "still here");
    EXPECT_EQ(store.session(1).remark, "still here");
}

TEST(Store, RefusesANewerDatabaseAndOneThatIsNone) {
    const test::TestFolder folder("store_new");
    { Store store(folder.path()); }
    Database(folder.path() + "/calot.sqlite").execute("PRAGMA user_version = 99");
    try {
        Store store(folder.path());
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.describe().find("newer Calot"), std::string::npos);
    }
    const test::TestFolder other("store_none");
    std::ofstream(other.path() + "/calot.sqlite") << std::string(4096, 'x');
    try {
        Store store(other.path());
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.describe().find("not a database"), std::string::npos) << error.describe();
    }
}

TEST(Store, SaysWhenItCannotWrite) {
    const test::TestFolder folder("store_file");
    std::ofstream(folder.path() + "/file") << "x";
    EXPECT_THROW(Store(folder.path() + "/file"), InputError);
    EXPECT_THROW(Store("/proc/calot"), InputError);
}

TEST(Store, TwoProgramsMayUseIt) {
    const test::TestFolder folder("store_two");
    Store one(folder.path()), two(folder.path());
    SessionLock lock_one, lock_two;
    SessionRow row;
    const std::int64_t a = one.begin(row, lock_one), b = two.begin(row, lock_two);
    EXPECT_NE(a, b);
    EXPECT_EQ(one.sessions().size(), 2u);
    // Both run: neither may be taken for dead. A lock that is let go is.
    EXPECT_TRUE(one.abandoned().empty());
    lock_one = SessionLock();
    EXPECT_TRUE(two.abandoned().empty() || two.abandoned() == std::vector<std::int64_t>{a});
}

TEST(Store, FindsSessionsWhoseProgramIsGone) {
    const test::TestFolder folder("store_gone");
    Store store(folder.path());
    std::int64_t id = 0;
    {
        SessionLock lock;
        id = store.begin({}, lock);
        EXPECT_TRUE(store.abandoned().empty());
    }
    EXPECT_EQ(store.abandoned(), std::vector<std::int64_t>{id});
}

TEST(Study, DrawsCurvesAndComputesSpreads) {
    EXPECT_DOUBLE_EQ(spread({2.0, 4.0, 4.0, 5.0, 5.0}).mean, 4.0);
    EXPECT_NEAR(spread({2.0, 4.0, 4.0, 5.0, 5.0}).deviation, 1.2247449, 1e-6);
    EXPECT_EQ(spread({3.0}).deviation, 0.0);
    EXPECT_EQ(spread({}).count, 0u);

    const test::TestFolder folder("study");
    Store store(folder.path());
    finished(store, "A", 40.0);
    finished(store, "B", 90.0);
    const SessionRow last = finished(store, "A", 60.0);
    store.answer(last.id, std::vector<std::optional<int>>(kQuestions, 4), "");
    store.answer(1, std::vector<std::optional<int>>(kQuestions, 2), "");
    SessionLock lock;
    SessionRow child;
    child.trainee = "A";
    child.task = "dissect";
    child.parent = 1;
    store.begin(child, lock);
    const Study study = make_study(store.sessions());
    ASSERT_EQ(study.curves.size(), 2u);
    ASSERT_EQ(study.curves[0].attempts.size(), 2u);
    EXPECT_DOUBLE_EQ(*study.curves[0].attempts[1].points, 60.0);
    EXPECT_DOUBLE_EQ(study.answers[0].mean, 3.0);
    EXPECT_NEAR(study.answers[0].deviation, std::sqrt(2.0), 1e-12);
    const std::string table = csv(store.sessions());
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
    const std::string head = table.substr(0, table.find('\r'));
    EXPECT_EQ(std::count(head.begin(), head.end(), ','),
              13 + static_cast<std::ptrdiff_t>(metric_table().size() + kQuestions));
}

TEST(Study, CsvKeepsFormulasHarmless) {
    SessionRow row;
    row.trainee = "=1+1";
    EXPECT_NE(csv({row}).find(",'=1+1,"), std::string::npos);
}

}  // namespace
}  // namespace calot::training
