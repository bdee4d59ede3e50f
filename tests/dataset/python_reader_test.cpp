// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <sstream>

#include "doorforge/core/hash.h"

#include "synthetic.h"

// python/doorforge_reader.py is a second reader of the format, written against the specification.

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Answer {
  int code;
  std::string output;  // both streams
};

Answer RunPython(const std::string& arguments) {
  const std::string command = "PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" DOORFORGE_SOURCE_DIR
                              "/python' /usr/bin/python3 " +
                              arguments + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string output;
  std::array<char, 4096> chunk{};
  while (std::fgets(chunk.data(), chunk.size(), pipe) != nullptr) output += chunk.data();
  const int status = ::pclose(pipe);
  return {WEXITSTATUS(status), output};
}

class PythonReaderTest : public synthetic::CollectionTest {
 protected:
  void SetUp() override {
    if (RunPython("-c 'import numpy'").code != 0)
      GTEST_SKIP() << "/usr/bin/python3 has no numpy here";
    CollectionTest::SetUp();
    CollectInto(folder_);
  }

  std::string Script() const {
    return "'" DOORFORGE_SOURCE_DIR "/python/doorforge_reader.py' '" + folder_.string() + "'";
  }
};

TEST_F(PythonReaderTest, SeesTheValuesThatWereWritten) {
  const fs::path script = folder_ / "dump.py";
  std::ofstream(script) << R"(
import hashlib, sys
import doorforge_reader
data = doorforge_reader.Dataset(sys.argv[1])
for part in data.parts:
    split = part.split
    for episode in data.episodes(part.stage, split):
        for name in sorted(episode.names()):
            array = episode[name]
            assert array.ctypes.data % 64 == 0 and not array.flags.owndata and not array.flags.writeable
            print(split, episode.key, name, array.dtype.str, *array.shape,
                  hashlib.sha256(array.tobytes()).hexdigest())
        print(split, episode.key, "door", episode.meta["scene"]["door_id"])
)";
  std::ostringstream expected;
  for (const char* split : {"train", "val"}) {
    const DatasetReader reader(folder_, "open", split);
    for (std::size_t i = 0; i < reader.size(); ++i) {
      const EpisodeArrays arrays = reader.Arrays(i);
      const auto line = [&](const char* name, const char* type, const std::string& shape,
                            std::span<const std::byte> bytes) {
        Sha256 hash;
        hash.Update(bytes);
        expected << split << ' ' << reader.entry(i).key << ' ' << name << ' ' << type << ' '
                 << shape << ' ' << hash.HexDigest() << '\n';
      };
      line("action", "<f4", "4 9", std::as_bytes(arrays.action));
      line("cloud", "<f4", "4 50 3", std::as_bytes(arrays.cloud));
      line("executed", "<f4", "4 9", std::as_bytes(arrays.executed));
      line("joints", "<f4", "4 2", std::as_bytes(arrays.joints));
      line("label", "|u1", "4 50", std::as_bytes(arrays.label));
      line("proprio", "<f4", "4 32", std::as_bytes(arrays.proprio));
      line("score", "<f4", "4 1", std::as_bytes(arrays.score));
      line("state", "<f8", "4 14", std::as_bytes(arrays.state));
      expected << split << ' ' << reader.entry(i).key << " door "
               << reader.Meta(i).at("scene").at("door_id").get<std::string>() << '\n';
    }
  }
  const Answer answer = RunPython("'" + script.string() + "' '" + folder_.string() + "'");
  EXPECT_EQ(answer.code, 0) << answer.output;
  EXPECT_EQ(answer.output, expected.str());
}

TEST_F(PythonReaderTest, PrintsASummary) {
  const Answer answer = RunPython(Script() + " --check");
  EXPECT_EQ(answer.code, 0) << answer.output;
  EXPECT_NE(answer.output.find("10 doors"), std::string::npos) << answer.output;
  EXPECT_NE(answer.output.find("6 grip_lost"), std::string::npos) << answer.output;
  EXPECT_NE(answer.output.find("open/train: "), std::string::npos) << answer.output;
}

TEST_F(PythonReaderTest, FindsTheFlippedBitThatTheIndexKnowsOf) {
  const fs::path part = folder_ / "open/train";
  const ShardMember member =
      ReadShardIndex(part / "shard-000000.index.json").episodes.at(2).members.at(3);
  std::fstream file(part / "shard-000000.tar", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(member.offset + member.size - 1));
  file.put('\x55');
  file.close();
  const Answer answer = RunPython(Script() + " --check");
  EXPECT_EQ(answer.code, 1);
  EXPECT_NE(answer.output.find("damaged: "), std::string::npos) << answer.output;
  EXPECT_NE(answer.output.find(member.name), std::string::npos) << answer.output;
}

TEST_F(PythonReaderTest, NamesACutShard) {
  fs::resize_file(folder_ / "open/train/shard-000000.tar", 5000);
  const Answer answer = RunPython(Script());
  EXPECT_EQ(answer.code, 3);
  EXPECT_NE(answer.output.find("5000 bytes, its index says"), std::string::npos) << answer.output;
}

}  // namespace
}  // namespace doorforge
