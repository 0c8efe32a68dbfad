// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs that end badly: killed at any point, with a torn journal or on a full disk. Each is resumed and must
// give the bytes of a run without interruption.
#include <csignal>
#include <functional>
#include <memory>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/dataset/dataset_reader.h"
#include "io/dataset/journal.h"
#include "io/dataset/verify.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::HasSubstr;

/// Runs `action` in a child process that ends without any clean-up. Returns the child's exit code.
int in_child(const std::function<int()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    int code = 99;
    try {
      code = action();
    } catch (const std::exception& error) {
      fprintf(stderr, "child: %s\n", error.what());
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

class Resume : public testing::Test {
 protected:
  /// Writes the run without interruption once for all tests.
  static void SetUpTestSuite() {
    whole_folder = std::make_unique<test::TemporaryFolder>();
    DatasetWriter writer(whole(), sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  static void TearDownTestSuite() { whole_folder.reset(); }
  static std::filesystem::path whole() { return whole_folder->path() / "whole"; }
  std::filesystem::path cut() const { return folder_.path() / "cut"; }

  /// Kills a run after `packets` packets. Unless `flush`, the last packets may not be written yet.
  void kill_after(int64_t packets, bool flush) {
    ASSERT_EQ(in_child([&] {
                DatasetWriter writer(cut(), info_, {.threads = 2});
                write_sample_run(writer, info_, packets);
                if (flush) writer.flush();
                ::_exit(7);
                return 0;
              }),
              7);
  }
  DatasetWriter::Position resume_and_compare() {
    DatasetWriter writer(cut(), info_, {.threads = 2, .resume = true});
    const DatasetWriter::Position position = writer.resume_position();
    EXPECT_TRUE(write_sample_run(writer, info_));
    EXPECT_EQ(contents(cut()), contents(whole()));
    return position;
  }

  const DatasetInfo info_ = sample_info();
  test::TemporaryFolder folder_;

 private:
  inline static std::unique_ptr<test::TemporaryFolder> whole_folder;
};

TEST_F(Resume, AKilledRunLeavesWholeRecordsAndIsFinishedToTheSameBytes) {
  for (const int64_t packets : {1, 2, 34, 69, 70, 71, 100, 139, 140}) {
    SCOPED_TRACE(packets);
    kill_after(packets, false);
    const DatasetReader reader(cut());
    EXPECT_FALSE(reader.finished());
    for (uint32_t sequence = 0; sequence < reader.sequences(); ++sequence) {
      for (const IndexRow& row : reader.records(sequence))
        for (const ArraySpec& array : reader.sensors()[static_cast<size_t>(row.sensor)].arrays)
          EXPECT_NO_THROW(reader.load(sequence, row, array.name));
    }
    ASSERT_EQ(verify(cut()).size(), 1u);
    EXPECT_THAT(verify(cut())[0].what, HasSubstr("unfinished"));
    resume_and_compare();
    std::filesystem::remove_all(cut());
  }
}

TEST_F(Resume, TheNextTickIsTheOneAfterTheLastCommit) {
  kill_after(100, true);
  const DatasetWriter::Position position = resume_and_compare();
  EXPECT_EQ(position.sequence, 1u);
  EXPECT_EQ(position.next_tick, 30);
}

TEST_F(Resume, KilledBySignal) {
  // The kill comes at an arbitrary time, so the test expects no particular packet.
  const pid_t child = ::fork();
  if (child == 0) {
    DatasetWriter writer(cut(), info_, {.threads = 2});
    write_sample_run(writer, info_);
    ::_exit(0);
  }
  ::usleep(3000);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  resume_and_compare();
}

TEST_F(Resume, ATornJournalLineIsDropped) {
  kill_after(50, true);
  const std::string text = read_text_file(cut() / "journal.txt");
  const size_t last = text.rfind('\n', text.size() - 2) + 1;
  for (const size_t keep : {last + 1, last + (text.size() - last) / 2, text.size() - 1}) {
    const std::filesystem::path copy = folder_.path() / "copy";
    std::filesystem::copy(cut(), copy, std::filesystem::copy_options::recursive);
    std::filesystem::resize_file(copy / "journal.txt", keep);
    DatasetWriter writer(copy, info_, {.resume = true});
    EXPECT_EQ(writer.resume_position().next_tick, 49);
    EXPECT_TRUE(write_sample_run(writer, info_));
    EXPECT_EQ(contents(copy), contents(whole()));
    std::filesystem::remove_all(copy);
  }
}

TEST_F(Resume, APacketWhoseFilesAreTornIsDropped) {
  const std::pair<const char*, int64_t> tears[] = {{"sequence_0000/uav/cam/rgb/000001.png", 33},
                                                   {"sequence_0000/poses/position.npy.part", 49},
                                                   {"sequence_0000/bs/csi/cfr.npy.part", 40},
                                                   {"sequence_0000/bs/csi/delay_offsets.npy.part", 40},
                                                   {"sequence_0000/uav/packed/records.chunks.part", 40},
                                                   {"sequence_0000/uav/packed/records.chunks.npy.part", 40}};
  for (const auto& [file, tick] : tears) {
    SCOPED_TRACE(file);
    kill_after(50, true);
    std::filesystem::resize_file(cut() / file, std::filesystem::file_size(cut() / file) - 1);
    EXPECT_EQ(resume_and_compare().next_tick, tick);
    std::filesystem::remove_all(cut());
  }
}

TEST_F(Resume, CutShortWhileASequenceIsClosed) {
  kill_after(70, true);
  // The state is as if publish() had renamed two of the stacks and the index was half written.
  for (const char* stack : {"sequence_0000/bs/csi/cfr.npy", "sequence_0000/poses/position.npy"})
    std::filesystem::rename(part_name(cut() / stack), cut() / stack);
  std::filesystem::copy_file(whole() / stack_path(0, info_.sensors[3], info_.sensors[3].outputs[0]),
                             cut() / "sequence_0000/poses/position.npy",
                             std::filesystem::copy_options::overwrite_existing);
  write_file_atomically(cut() / "sequence_0000/index.npy", std::string_view("half"));
  EXPECT_EQ(resume_and_compare().next_tick, 70);
}

TEST_F(Resume, CutShortWhilePackedRecordsAreClosed) {
  kill_after(70, true);
  // The state is as if publish() had named the HDF5 file, but not yet its table.
  const std::string base = "sequence_0000/uav/packed/records";
  std::filesystem::copy_file(whole() / (base + ".h5"), cut() / (base + ".h5"));
  std::filesystem::copy_file(whole() / (base + ".npy"), cut() / (base + ".npy.part"));
  EXPECT_EQ(resume_and_compare().next_tick, 70);
  std::filesystem::remove_all(cut());
  // The end of the sequence is in the journal, and what the HDF5 file was made of still lies there.
  kill_after(100, true);
  for (const char* rest : {".chunks.part", ".chunks.npy.part"})
    write_file_atomically(cut() / (base + rest), std::string_view("left over"));
  EXPECT_EQ(resume_and_compare().sequence, 1u);
}

TEST_F(Resume, CutShortBeforeTheManifestAndAfterIt) {
  kill_after(140, true);
  {
    DatasetWriter writer(cut(), info_, {.resume = true});
    EXPECT_EQ(writer.resume_position().next_tick, 70);
    writer.begin_sequence(1);
    writer.end_sequence();
  }
  write_file_atomically(cut() / "manifest.json.part", std::string_view("{"));
  EXPECT_EQ(resume_and_compare().sequence, 2u);
  write_file_atomically(cut() / "journal.txt", std::string_view("left over"));
  EXPECT_EQ(verify(cut()).size(), 1u);
  EXPECT_TRUE(resume_and_compare().finished);
}

TEST_F(Resume, NothingWasWrittenYet) {
  std::filesystem::create_directories(cut());
  write_file_atomically(cut() / "dataset.json.part", std::string_view("{"));
  std::filesystem::resize_file(cut() / "dataset.json.part", 1);
  EXPECT_EQ(resume_and_compare().next_tick, 0);
}

TEST_F(Resume, AClosedSequenceThatLostAFileIsNotResumed) {
  kill_after(100, true);
  std::filesystem::remove(cut() / "sequence_0000/bs/csi/cfr.npy");
  EXPECT_THROW(DatasetWriter(cut(), info_, {.resume = true}), UserError);
}

/// Limits the size of a file instead of the disk. The code takes the same path, and no disk needs to be
/// filled.
TEST_F(Resume, AFullDiskIsAUserErrorAndResumable) {
  for (const rlim_t limit : {400, 1000, 2500, 5000, 9000, 12000, 16000, 20000}) {
    SCOPED_TRACE(limit);
    const std::filesystem::path log = folder_.path() / "message";
    ASSERT_EQ(in_child([&] {
                std::string message;
                const rlimit small{limit, limit};
                const File out = File::open_for_writing(log);
                ::setrlimit(RLIMIT_FSIZE, &small);
                try {
                  DatasetWriter writer(cut(), info_, {.threads = 2});
                  write_sample_run(writer, info_);
                  return 1;
                } catch (const UserError& error) {
                  message = error.what();
                }
                const ssize_t written =
                    ::write(out.descriptor(), message.data(), std::min<size_t>(message.size(), 399));
                return written > 0 ? 3 : 2;
              }),
              3);
    const std::string message = read_text_file(log);
    EXPECT_THAT(message, HasSubstr("cannot be written: File too large"));
    EXPECT_THAT(message, HasSubstr((folder_.path() / "cut").string()));
    if (std::filesystem::exists(cut() / "dataset.json")) {
      EXPECT_THAT(message, HasSubstr("--resume finishes it"));
    }
    resume_and_compare();
    std::filesystem::remove_all(cut());
    std::filesystem::remove(log);
  }
}

TEST(Journal, LinesRoundTripAndAFlippedByteEndsIt) {
  const JournalPacket packet{3, 77, 77000000, {{0, 2}, {5, 77}}, {{1234, std::string(64, 'a')}}};
  const JournalEnd end{3, {{"sequence_0003/x \"y\".npy", 99, std::string(64, 'b')}}};
  const std::string text = journal_line(packet) + journal_line(end);
  const std::vector<JournalEntry> entries = parse_journal(text);
  ASSERT_EQ(entries.size(), 2u);
  const auto& back = std::get<JournalPacket>(entries[0].entry);
  EXPECT_EQ(back.sequence, 3u);
  EXPECT_EQ(back.tick, 77);
  EXPECT_EQ(back.records[1].sensor, 5u);
  EXPECT_EQ(back.frames[0].size, 1234u);
  EXPECT_EQ(std::get<JournalEnd>(entries[1].entry).files[0].path, "sequence_0003/x \"y\".npy");
  EXPECT_EQ(entries[1].end, text.size());
  for (size_t at = 0; at < text.size(); ++at) {
    std::string bad = text;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    EXPECT_LT(parse_journal(bad).size(), 2u) << at;
  }
}

}  // namespace
}  // namespace greatx::io
