// SPDX-License-Identifier: Apache-2.0
// The protocol of the peers: the real ones that are there, and stand-ins that break it.
#include "bench/peers.hpp"

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/families.hpp"

namespace cadt::bench {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, and an interpreter for the stand-ins.
class Peers : public testing::Test {
 protected:
  Peers() : folder_(fs::temp_directory_path() / ("cadt-peers-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Peers() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string points_file(const std::vector<double>& xy) const {
    const fs::path file = folder_ / "points.f64";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(xy.data()), static_cast<std::streamsize>(xy.size() * sizeof(double)));
    return file.string();
  }
  Peer stand_in(const std::string& program) const {
    const fs::path file = folder_ / "stand_in.py";
    std::ofstream(file) << "import json, sys, time\n" << program << '\n';
    return {"stand-in", {CADT_TEST_PYTHON, file.string()}, "", ""};
  }
  PeerResult answer(const std::string& program, double limit = 10.0) const {
    return run_peer(stand_in(program), "points.f64", 1, 3, limit);
  }
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

const Peer& named(const std::vector<Peer>& peers, const std::string& name) {
  return *std::ranges::find(peers, name, &Peer::name);
}

std::size_t triangles_of(const std::vector<double>& xy) {
  Options options;
  options.backend = Backend::host;
  return triangulate(std::span<const double>(xy), options).number_of_triangles();
}

TEST_F(Peers, AllAreListed) {
  const std::vector<Peer> peers = find_peers(CADT_TEST_PROGRAM_FOLDER);
  ASSERT_EQ(peers.size(), 3u);
  EXPECT_EQ(peers[0].name, "cgal");
  EXPECT_EQ(peers[1].name, "scipy");
  EXPECT_EQ(peers[2].name, "cupy");
  for (const Peer& peer : peers) EXPECT_NE(peer.version.empty(), peer.reason.empty()) << peer.name;
}

TEST_F(Peers, CgalAnswers) {
  const Peer cgal = named(find_peers(CADT_TEST_PROGRAM_FOLDER), "cgal");
  ASSERT_TRUE(cgal.usable()) << cgal.reason;
  for (const std::vector<double>& xy :
       {test::uniform_points(5000), test::grid_points(30, 40), test::grid_points(1, 5), std::vector<double>{}}) {
    const PeerResult result = run_peer(cgal, points_file(xy), 1, 3, 60.0);
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(result.name, "cgal");
    EXPECT_EQ(result.version, cgal.version);
    EXPECT_EQ(result.triangles, triangles_of(xy));
    EXPECT_EQ(result.warmups, 1u);
    EXPECT_EQ(result.milliseconds.size(), 3u);
  }
}

TEST_F(Peers, CgalStopsAtTheLimitButForOneRun) {
  const Peer cgal = named(find_peers(CADT_TEST_PROGRAM_FOLDER), "cgal");
  ASSERT_TRUE(cgal.usable()) << cgal.reason;
  const PeerResult result = run_peer(cgal, points_file(test::uniform_points(5000)), 1000000, 1000000, 0.2);
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.milliseconds.size(), 1u);                                       // the warm-up took all of it
  EXPECT_TRUE(result.warmups >= 1 && result.warmups < 1000000) << result.warmups;  // those made, not those asked for
  const PeerResult at_once = run_peer(cgal, points_file(test::uniform_points(50)), 2, 4, 0.0);
  EXPECT_EQ(at_once.warmups, 0u);
  EXPECT_EQ(at_once.milliseconds.size(), 1u);
}

TEST_F(Peers, CgalSaysWhatItCannotRead) {
  const Peer cgal = named(find_peers(CADT_TEST_PROGRAM_FOLDER), "cgal");
  ASSERT_TRUE(cgal.usable()) << cgal.reason;
  EXPECT_NE(run_peer(cgal, (folder() / "none.f64").string(), 0, 1, 1.0).error.find("none.f64"), std::string::npos);
  EXPECT_NE(run_peer(cgal, points_file({1, 2, 3}), 0, 1, 1.0).error.find("whole points"), std::string::npos);
}

// Each is tested with real numbers where it is installed, else its reason must be the missing module or device.
TEST_F(Peers, PythonAnswersOrSaysWhyNot) {
  const std::vector<double> xy = test::uniform_points(2000);
  const auto peers = find_peers(CADT_TEST_PROGRAM_FOLDER);
  for (const char* name : {"scipy", "cupy"}) {
    const Peer& peer = named(peers, name);
    const PeerResult result = run_peer(peer, points_file(xy), 1, 2, 60.0);
    EXPECT_EQ(result.name, name);
    if (!peer.usable()) {
      EXPECT_EQ(result.error, peer.reason);
      EXPECT_NE(peer.reason.find("Error: "), std::string::npos) << peer.reason;
      EXPECT_EQ(result.milliseconds.size(), 0u);
      continue;
    }
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(result.version, peer.version);
    EXPECT_EQ(result.warmups, 1u);
    EXPECT_EQ(result.milliseconds.size(), 2u);
    const PeerResult at_once = run_peer(peer, points_file(xy), 3, 2, 0.0);
    EXPECT_EQ(at_once.warmups, 0u);
    EXPECT_EQ(at_once.milliseconds.size(), 1u);
    EXPECT_EQ(result.timing, peer.name == "cupy" ? "device" : "host");
    if (peer.name == "cupy") continue;  // its mesh may have another number of triangles
    EXPECT_EQ(result.triangles, triangles_of(xy));
  }
}

/// Python's module `scipy` as this folder has it.
TEST_F(Peers, PythonWithoutTheModuleIsNotUsable) {
  std::ofstream(folder() / "scipy.py") << "raise ImportError('not today')\n";
  ASSERT_EQ(setenv("PYTHONPATH", folder().c_str(), 1), 0);
  const Peer peer = named(find_peers(CADT_TEST_PROGRAM_FOLDER), "scipy");
  unsetenv("PYTHONPATH");
  EXPECT_EQ(peer.reason, "ImportError: not today");
  EXPECT_EQ(run_peer(peer, points_file({}), 0, 1, 1.0).error, "ImportError: not today");
}

TEST_F(Peers, WhatIsNotBesideTheProgramIsNotUsable) {
  const auto peers = find_peers(folder());
  ASSERT_EQ(peers.size(), 3u);
  for (const Peer& peer : peers) {
    EXPECT_NE(peer.reason.find("is not there"), std::string::npos) << peer.reason;
    EXPECT_EQ(run_peer(peer, "points.f64", 0, 1, 1.0).error, peer.reason);
  }
}

TEST_F(Peers, WithoutPythonOnThePath) {
  fs::copy_file(fs::path(CADT_TEST_PROGRAM_FOLDER) / "cadt-peer-python.py", folder() / "cadt-peer-python.py");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder().c_str(), 1);
  const Peer peer = named(find_peers(folder()), "scipy");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(peer.reason, "no python3 on the path");
}

TEST_F(Peers, AProperAnswerIsRead) {
  const PeerResult result = answer(
      "print(json.dumps({'name': 'x', 'version': '1.2', 'triangles': 12, 'warmups': 2, 'milliseconds': [1.5, 2], "
      "'timing': 'device', 'more': sys.argv[1:]}))");
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.name, "stand-in");
  EXPECT_EQ(result.version, "1.2");
  EXPECT_EQ(result.triangles, 12u);
  EXPECT_EQ(result.warmups, 2u);
  EXPECT_EQ(result.milliseconds, (std::vector<double>{1.5, 2.0}));
  EXPECT_EQ(result.timing, "device");
}

TEST_F(Peers, TheArgumentsAreThoseOfTheProtocol) {
  const PeerResult result = answer("print(json.dumps({'error': ' '.join(sys.argv[1:])}))", 2.5);
  EXPECT_EQ(result.error, "points.f64 --warm-up 1 --runs 3 --limit 2.500000");
}

TEST_F(Peers, AnErrorOfItsOwnIsHandedOn) {
  EXPECT_EQ(answer("print(json.dumps({'name': 'x', 'error': 'too thin'}))").error, "too thin");
  EXPECT_EQ(answer("print(json.dumps({'name': 'x', 'error': 'no card'})); sys.exit(3)").error, "no card");
  EXPECT_EQ(answer("print(json.dumps({'name': 'x'})); sys.exit(3)").error, "not usable");
}

TEST_F(Peers, RubbishIsAnError) {
  EXPECT_EQ(answer("pass").error, "it said nothing");
  EXPECT_EQ(answer("print('hello')").error, "it said: hello");
  EXPECT_EQ(answer("print('[1, 2]')").error, "it said: [1, 2]");
  EXPECT_EQ(answer("print(json.dumps({'triangles': 1, 'warmups': 0, 'milliseconds': []}))").error, "it has no times");
  EXPECT_EQ(answer("print(json.dumps({'triangles': 1, 'warmups': 0, 'milliseconds': [1, -1]}))").error,
            "a time is not a time");
  for (const char* wrong :
       {"{}", "{'triangles': 1}", "{'warmups': 0, 'milliseconds': [1]}", "{'triangles': 1, 'milliseconds': [1]}",
        "{'triangles': 'a', 'warmups': 0, 'milliseconds': [1]}",
        "{'triangles': 1, 'warmups': 'a', 'milliseconds': [1]}", "{'triangles': 1, 'warmups': 0, 'milliseconds': 'b'}",
        "{'triangles': 1, 'warmups': 0, 'milliseconds': [None]}"}) {
    const PeerResult result = answer(std::string("print(json.dumps(") + wrong + "))");
    EXPECT_NE(result.error.find("cannot be read"), std::string::npos) << wrong;
    EXPECT_TRUE(result.milliseconds.empty() && result.triangles == 0) << wrong;
  }
}

TEST_F(Peers, ACrashIsAnErrorEvenAfterAnAnswer) {
  const std::string proper = "print(json.dumps({'triangles': 1, 'warmups': 0, 'milliseconds': [1]}), flush=True)\n";
  EXPECT_EQ(answer(proper + "raise RuntimeError('afterwards')").error, "ended with 1: RuntimeError: afterwards");
  EXPECT_EQ(answer(proper + "import os; os.abort()").error.substr(0, 17), "ended by signal 6");
}

TEST_F(Peers, AHangingOneIsKilled) {
  const auto start = std::chrono::steady_clock::now();
  // The time that run_peer allows is half a minute and three times the limit; a negative limit takes some of it back.
  const PeerResult result = answer("time.sleep(300)", -9.8);
  EXPECT_EQ(result.error, "killed after 0.6 s");
  EXPECT_TRUE(result.too_slow);
  EXPECT_FALSE(answer("pass").too_slow);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST_F(Peers, AMissingProgramIsAnError) {
  const PeerResult result = run_peer({"gone", {(folder() / "gone").string()}, "", ""}, "points.f64", 0, 1, 1.0);
  EXPECT_EQ(result.error.substr(0, 12), "cannot start");
}

}  // namespace
}  // namespace cadt::bench
