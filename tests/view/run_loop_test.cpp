// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests commands, pace, errors and the end of a run's thread, with ticks that cost nothing.
#include "view/run/run_loop.h"

#include <cmath>
#include <limits>
#include <set>

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/view/run_support.h"
#include "view/run/record_store.h"

namespace greatx::view {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

/// What the fake source is told to do, and what it has been asked for. Shared by the threads.
struct Script {
  uint32_t sequences = 2;
  int64_t ticks = 100, every = 10;  ///< ticks of a sequence, of 10 ms; a sensor is due at every 10th
  std::set<int64_t> faulty, endless;
  std::set<uint32_t> empty;  ///< sequences without ticks
  std::atomic<int> opened{0}, loads{0}, ahead{0};
  std::atomic<int> stopped{0};  ///< loads that ended with Interrupted
  bool endless_open = false;
};

class FakeTicks : public TickSource {
 public:
  explicit FakeTicks(Script& script) : script_(script) {
    auto info = std::make_shared<io::DatasetInfo>();
    info->tick_rate = "100";
    info->sequences = script.sequences;
    info->ticks_per_sequence = script.ticks;
    info_ = info;
    ++script.opened;
    while (script.endless_open) checkpoint();
  }
  std::shared_ptr<const io::DatasetInfo> info() const override { return info_; }
  int64_t next(uint32_t sequence, int64_t tick) const override {
    const int64_t due = (tick + script_.every - 1) / script_.every * script_.every;
    return due < script_.ticks && !script_.empty.contains(sequence) ? due : -1;
  }
  int64_t previous(uint32_t sequence, int64_t tick) const override {
    if (script_.empty.contains(sequence)) return -1;
    return tick <= 0 ? -1 : (tick - 1) / script_.every * script_.every;
  }
  Loaded load(TickAt at, bool, const std::function<bool()>&) override {
    const Activity activity("making a tick");
    ++script_.loads;
    if (script_.faulty.contains(at.tick)) throw UserError("a fault");
    if (script_.endless.contains(at.tick)) {
      try {
        WorkStage stage("an endless search");
        stage.expect(4.0);
        stage.add(1);
        for (;;) checkpoint();
      } catch (const Interrupted&) {
        ++script_.stopped;
        throw;
      }
    }
    auto shown = std::make_shared<ShownTick>();
    shown->sequence = at.sequence;
    shown->packet.tick = at.tick;
    shown->packet.time_ns = at.tick * 10'000'000;
    return {shown, {}, false};
  }
  bool look_ahead(TickAt, bool) override { return ++script_.ahead % 3 != 0; }

 private:
  Script& script_;
  std::shared_ptr<const io::DatasetInfo> info_;
};

std::unique_ptr<Run> looped(RunLoop::Open open, bool playing) {
  return std::make_unique<Looped<Run>>(std::move(open), playing);
}
std::unique_ptr<Run> fake_run(Script& script, bool playing = false) {
  return looped([&script] { return std::make_unique<FakeTicks>(script); }, playing);
}

TEST(RunLoop, ShowsTheFirstTickAndWaits) {
  Script script;
  const auto run = fake_run(script);
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  const RunStatus status = run->status();
  EXPECT_EQ(status.phase, RunStatus::Phase::ready);
  EXPECT_FALSE(status.playing);
  EXPECT_EQ(status.tick, 0);
  EXPECT_EQ(run->info()->sequences, 2u);
  const uint64_t version = run->version();
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_TRUE(shows(*run, 0, 0));
  EXPECT_EQ(run->version(), version) << "nothing changes";
  EXPECT_EQ(script.loads, 1);
}

TEST(RunLoop, StepsCountFromTheTickBeforeAndCrossSequences) {
  Script script;
  const auto run = fake_run(script);
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  run->step(3);
  EXPECT_TRUE(wait_for_tick(*run, 0, 30));
  for (int i = 0; i < 5; ++i) run->step(1);
  EXPECT_TRUE(wait_for_tick(*run, 0, 80));
  run->step(2);
  EXPECT_TRUE(wait_for_tick(*run, 1, 0));
  run->step(-1);
  EXPECT_TRUE(wait_for_tick(*run, 0, 90));
  run->step(-1000);
  EXPECT_TRUE(wait_for_tick(*run, 0, 0));
  run->step(std::numeric_limits<int>::max());
  EXPECT_TRUE(wait_for_tick(*run, 1, 90));
  run->step(std::numeric_limits<int>::min());
  run->step(1);  // from the first tick, however far back the step before would have gone
  EXPECT_TRUE(wait_for_tick(*run, 0, 10));
  run->step(0);
  EXPECT_TRUE(wait_for_tick(*run, 0, 10));
}

TEST(RunLoop, StepsWhileItOpensCountFromTheFirstTick) {
  Script script;
  const auto run = fake_run(script);
  run->step(1);
  run->step(1);
  EXPECT_TRUE(wait_for_tick(*run, 0, 20));
}

TEST(RunLoop, JumpsShowTheNextDueTickOrTheLast) {
  Script script;
  const auto run = fake_run(script);
  run->jump(1, 41);
  EXPECT_TRUE(wait_for_tick(*run, 1, 50)) << "also while it opens";
  run->jump(0, 30);
  EXPECT_TRUE(wait_for_tick(*run, 0, 30));
  run->jump(1, 99);
  EXPECT_TRUE(wait_for_tick(*run, 1, 90));
  run->jump(0, 10);
  run->jump(0, 20);
  run->step(2);
  EXPECT_TRUE(wait_for_tick(*run, 0, 40));
  run->step(7);
  run->jump(1, 0);  // whatever came before
  EXPECT_TRUE(wait_for_tick(*run, 1, 0));
}

TEST(RunLoop, JumpsThatLeadNowhereSaySo) {
  Script script;
  script.empty = {1};
  const auto run = fake_run(script);
  run->jump(2, 0);
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_EQ(run->status().error, "expected a sequence from 0 to 1, found 2");
  EXPECT_TRUE(shows(*run, 0, 0)) << "the first tick, for want of another";
  run->jump(0, 100);
  ASSERT_TRUE(wait_until([&] { return run->status().error == "expected a tick from 0 to 99, found 100"; }));
  run->jump(0, -1);
  ASSERT_TRUE(wait_until([&] { return run->status().error == "expected a tick from 0 to 99, found -1"; }));
  run->jump(1, 5);
  ASSERT_TRUE(wait_until([&] { return run->status().error.find("sequence 1 has no tick") == 0; }));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  run->jump(0, 50);
  EXPECT_TRUE(wait_until([&] { return run->status().error.empty() && shows(*run, 0, 50); }));
}

TEST(RunLoop, PlaysAllSequencesToTheEndAndPauses) {
  Script script;
  script.empty = {1};
  script.sequences = 3;
  const auto run = fake_run(script);
  run->set_speed(0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  EXPECT_TRUE(shows(*run, 2, 90));
  EXPECT_EQ(script.loads, 20);
  EXPECT_EQ(run->status().reached, 0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  EXPECT_TRUE(shows(*run, 2, 90));
  run->jump(2, 70);
  EXPECT_TRUE(wait_for_tick(*run, 2, 70));
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  EXPECT_TRUE(shows(*run, 2, 90));
}

TEST(RunLoop, NoTickComesAheadOfItsTime) {
  Script script;
  script.sequences = 1;
  const auto run = fake_run(script);
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  run->set_speed(2.0);  // 50 ms from tick to tick
  const Clock::time_point begin = Clock::now();
  run->play(true);
  for (int64_t tick = 10; tick <= 50; tick += 10) {
    ASSERT_TRUE(wait_until([&] { return run->shown()->packet.tick >= tick; }));
    const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
    EXPECT_GE(wall_s, double(run->shown()->packet.tick) * 0.01 / 2.0);
  }
  EXPECT_LE(run->status().reached, 2.0 + 1e-9);
  EXPECT_GT(run->status().reached, 0.0);
  EXPECT_GT(script.ahead, 0) << "the time until then is used";
}

TEST(RunLoop, ATinySpeedWaitsAndGivesWay) {
  Script script;
  const auto run = fake_run(script, true);
  run->set_speed(1e-300);
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  std::this_thread::sleep_for(milliseconds(30));
  const int64_t before = run->shown()->packet.tick;
  std::this_thread::sleep_for(milliseconds(30));
  EXPECT_EQ(run->shown()->packet.tick, before);
  run->set_speed(0.0);
  ASSERT_TRUE(wait_for_pause(*run));
  EXPECT_TRUE(shows(*run, 1, 90));
  EXPECT_THROW(run->set_speed(-1.0), ContractError);
  EXPECT_THROW(run->set_speed(std::nan("")), ContractError);
}

TEST(RunLoop, NothingMovesAfterAPause) {
  Script script;
  script.ticks = 1'000'000;
  const auto run = fake_run(script);
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  run->set_speed(0.0);
  for (int i = 0; i < 50; ++i) {
    run->play(true);
    std::this_thread::sleep_for(std::chrono::microseconds(37 * i));
    i % 2 == 0 ? run->play(false) : run->step(0);
    const std::shared_ptr<const ShownTick> shown = run->shown();
    EXPECT_FALSE(run->status().playing);
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    EXPECT_EQ(run->shown(), shown);
  }
}

TEST(RunLoop, AJumpWhilePlayingPlaysOn) {
  Script script;
  script.ticks = 1'000'000'000;
  const auto run = fake_run(script, true);
  run->set_speed(0.0);
  run->jump(1, 900'000'000);
  ASSERT_TRUE(wait_until([&] { return run->status().sequence == 1 && run->status().tick > 900'000'100; }));
  EXPECT_TRUE(run->status().playing);
  run->step(-1);
  EXPECT_FALSE(run->status().playing);
}

TEST(RunLoop, AfterAFaultyTickTheOthersAreThere) {
  Script script;
  script.faulty = {30, 60};
  const auto run = fake_run(script);
  run->set_speed(0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_EQ(run->status().error, "a fault (sequence 0, tick 30)");
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  EXPECT_FALSE(run->status().playing);
  EXPECT_TRUE(shows(*run, 0, 20));
  run->play(true);  // goes on behind it
  ASSERT_TRUE(wait_until([&] { return run->status().error == "a fault (sequence 0, tick 60)"; }));
  run->step(-1);
  EXPECT_TRUE(wait_until([&] { return shows(*run, 0, 50) && run->status().error.empty(); }));
  run->step(1);
  ASSERT_TRUE(wait_for_error(*run));
  run->step(1);
  EXPECT_TRUE(wait_until([&] { return shows(*run, 0, 70) && run->status().error.empty(); }));
}

TEST(RunLoop, AFailureToOpenIsToldAndCommandsDoNothing) {
  const auto open = []() -> std::unique_ptr<TickSource> {
    throw UserError(SourceLocation{"x.yaml", 7}, "expected a fault");
  };
  const auto run = looped(open, true);
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::failed);
  EXPECT_EQ(run->status().error, "x.yaml:7: expected a fault");
  EXPECT_FALSE(run->status().playing);
  run->play(true);
  run->step(1);
  run->jump(0, 0);
  run->set_speed(3.0);
  EXPECT_FALSE(run->status().playing);
  EXPECT_EQ(run->info(), nullptr);
  EXPECT_EQ(run->shown(), nullptr);
}

TEST(RunLoop, OutOfMemoryIsAnError) {
  const auto open = []() -> std::unique_ptr<TickSource> { throw std::bad_alloc(); };
  const auto run = looped(open, true);
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_THAT(run->status().error, HasSubstr("out of memory"));
}

TEST(RunLoop, WithoutATickNothingIsShown) {
  Script script;
  script.empty = {0, 1};
  const auto run = fake_run(script, true);
  ASSERT_TRUE(wait_for_pause(*run));
  run->step(1);
  run->step(-1);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  EXPECT_EQ(run->status().tick, -1);
  EXPECT_EQ(run->status().error, "");
  EXPECT_EQ(run->shown(), nullptr);
}

TEST(RunLoop, EndsWhileItOpensSearchesWaitsOrPlays) {
  {
    Script script;
    script.endless_open = true;
    const auto run = fake_run(script);
    ASSERT_TRUE(wait_until([&] { return script.opened == 1; }));
  }
  for (const bool playing : {false, true}) {
    Script script;
    script.endless = {10};
    {
      const auto run = fake_run(script, playing);
      run->set_speed(0.0);
      if (!playing) run->step(1);
      ASSERT_TRUE(wait_until([&] { return run->status().progress == 0.25; }));
      EXPECT_EQ(run->status().activity, "making a tick");
    }
    EXPECT_EQ(script.stopped, 1);
  }
  for (const double speed : {0.0, 1e-9}) {
    Script script;
    script.ticks = 1'000'000'000;
    const auto run = fake_run(script, true);
    run->set_speed(speed);
    ASSERT_TRUE(wait_until([&] { return run->shown() != nullptr; }));
  }
  Script script;
  fake_run(script);  // at once
}

TEST(RunLoop, ALongSearchGivesWayToACommand) {
  Script script;
  script.endless = {10};
  const auto run = fake_run(script);
  run->step(1);
  ASSERT_TRUE(wait_until([&] { return run->status().progress == 0.25; }));
  run->jump(1, 50);
  EXPECT_TRUE(wait_for_tick(*run, 1, 50));
  EXPECT_EQ(script.stopped, 1);
  EXPECT_EQ(run->status().progress, -1.0);
  EXPECT_TRUE(wait_until([&] { return run->status().activity.empty(); }));
}

TEST(RunLoop, CommandsFromManyThreads) {
  Script script;
  script.faulty = {20};
  const auto run = fake_run(script, true);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 500; ++i) {
        switch ((i + t) % 5) {
          case 0:
            run->step(i % 7 - 3);
            break;
          case 1:
            run->jump(i % 3, i % 110);
            break;
          case 2:
            run->play(i % 2 == 0);
            break;
          case 3:
            run->set_speed(i % 4);
            break;
          default: {
            const RunStatus status = run->status();
            const std::shared_ptr<const ShownTick> shown = run->shown();
            if (shown) {
              EXPECT_EQ(shown->packet.time_ns, shown->packet.tick * 10'000'000);
            }
            EXPECT_LE(status.tick, 90);
          }
        }
      }
    });
  for (std::thread& thread : threads) thread.join();
  run->play(false);
  run->jump(1, 70);
  EXPECT_TRUE(wait_until([&] { return shows(*run, 1, 70) && run->status().error.empty(); }));
}

std::shared_ptr<const Record> record_of(uint32_t sensor, int64_t tick, int64_t bytes) {
  Record record{sensor, tick, 0, 0, {}};
  record.arrays.emplace_back(DType::u8, std::vector<int64_t>{bytes});
  return std::make_shared<const Record>(std::move(record));
}

TEST(RecordStore, ForgetsWhatNobodyHasAskedForLongest) {
  const uint64_t each = bytes_of(*record_of(0, 0, 1000));
  RecordStore store(3 * each);
  for (int64_t tick = 0; tick < 3; ++tick) {
    store.begin_turn();
    store.put(0, {record_of(0, tick, 1000), double(tick)});
  }
  EXPECT_EQ(store.bytes(), 3 * each);
  store.begin_turn();
  EXPECT_NE(store.find(0, 0, 0).record, nullptr);
  store.put(0, {record_of(0, 3, 1000), 3.0});
  for (int turn = 0; turn < 3; ++turn) store.begin_turn();
  EXPECT_EQ(store.bytes(), 3 * each);
  EXPECT_TRUE(store.has(0, 0, 0));
  EXPECT_FALSE(store.has(0, 0, 1)) << "the one asked for longest ago";
  EXPECT_EQ(store.find(0, 0, 3).milliseconds, 3.0);
  EXPECT_EQ(store.newest(0, 0, 1).record->tick, 0);
  EXPECT_EQ(store.newest(0, 0, 100).record->tick, 3);
  EXPECT_EQ(store.newest(0, 1, 100).record, nullptr) << "another sensor";
  EXPECT_EQ(store.newest(1, 0, 100).record, nullptr) << "another sequence";
}

TEST(RecordStore, KeepsThePresentTurnAndTheOneBeforeHoweverLarge) {
  RecordStore store(10);
  store.begin_turn();
  store.put(0, {record_of(0, 0, 5000), 0.0});
  store.put(0, {record_of(1, 0, 5000), 0.0});
  store.begin_turn();
  store.put(0, {record_of(0, 1, 5000), 0.0});
  EXPECT_TRUE(store.has(0, 0, 0) && store.has(0, 1, 0));
  store.begin_turn();
  EXPECT_FALSE(store.has(0, 0, 0) || store.has(0, 1, 0));
  EXPECT_TRUE(store.has(0, 0, 1));
  store.put(0, {record_of(0, 1, 1), 0.0});  // in its place
  EXPECT_EQ(store.bytes(), bytes_of(*record_of(0, 1, 1)));
}

}  // namespace
}  // namespace greatx::view
