// SPDX-License-Identifier: Apache-2.0
// Films through a program called ffmpeg. Here it is a script, so that it fails when it is to.
#include "viewer/growth/video.hpp"

#include <cadt/io/errors.hpp>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace cadt::viewer {
namespace {

namespace fs = std::filesystem;

class VideoTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* path = std::getenv("PATH");
    path_before_ = path != nullptr ? path : "";
    folder_ = fs::path(testing::TempDir()) / ("cadt-video-" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "bin");
    fs::create_directories(folder_ / "out");
  }
  void TearDown() override {
    ::setenv("PATH", path_before_.c_str(), 1);
    fs::remove_all(folder_);
  }
  /// The text of a program that stands for ffmpeg. `$out` is the file that it is to write.
  void install(const std::string& text) {
    const fs::path file = folder_ / "bin" / "ffmpeg";
    std::ofstream(file) << "#!/bin/sh\nfor out; do :; done\nout=${out#file:}\n" << text << "\n";
    ::chmod(file.c_str(), 0755);
    ::setenv("PATH", ((folder_ / "bin").string() + ":" + path_before_).c_str(), 1);
  }
  [[nodiscard]] std::string target() const { return (folder_ / "out" / "film.mp4").string(); }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / "out"), fs::directory_iterator()));
  }
  static Image picture(std::uint8_t byte) { return {64, 48, std::vector<std::uint8_t>(64 * 48 * 4, byte)}; }

  fs::path folder_;
  std::string path_before_;
};

std::string failure_of(const auto& work) {
  try {
    work();
  } catch (const io::FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(VideoTest, AllPicturesReachTheFile) {
  install("echo \"$@\" > \"$(dirname \"$0\")/arguments\"; cat > \"$out\"");
  Video video(target(), 64, 48, 25);
  video.write(picture(7));
  video.write(picture(9));
  EXPECT_FALSE(fs::exists(target())) << "it has its name before it is complete";
  video.finish();
  EXPECT_EQ(fs::file_size(target()), 2u * 64 * 48 * 4);
  EXPECT_EQ(files(), 1u) << "something stays behind";
  std::ifstream file(folder_ / "bin" / "arguments");
  const std::string arguments((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(arguments.find("-s 64x48 -r 25 -i -"), std::string::npos) << arguments;
  EXPECT_NE(arguments.find("-f mp4"), std::string::npos) << arguments;
}

TEST_F(VideoTest, FailuresHaveTheLastLine) {
  install("cat > /dev/null; echo first >&2; echo 'no such codec' >&2; exit 3");
  std::ofstream(target()) << "the film before";
  const std::string message = failure_of([&] {
    Video video(target(), 64, 48, 25);
    video.write(picture(1));
    video.finish();
  });
  EXPECT_NE(message.find("ffmpeg ended with exit code 3: no such codec"), std::string::npos) << message;
  EXPECT_EQ(files(), 1u);
  EXPECT_EQ(fs::file_size(target()), 15u) << "what was there is gone";
}

TEST_F(VideoTest, AnEarlyEndIsAnErrorAndNoSignal) {
  install("echo 'the disk is full' >&2; exit 1");
  const std::string message = failure_of([&] {
    Video video(target(), 64, 48, 25);
    for (int i = 0; i < 1000; ++i) video.write(picture(1));
    video.finish();
  });
  EXPECT_NE(message.find("exit code 1: the disk is full"), std::string::npos) << message;
  EXPECT_EQ(files(), 0u);
}

TEST_F(VideoTest, NothingStaysOfAFilmThatIsNotFinished) {
  install("touch \"$out\"; cat > /dev/null; sleep 100");
  {
    Video video(target(), 64, 48, 25);
    video.write(picture(1));
    while (files() == 0) ::usleep(1000);
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(VideoTest, AMissingProgramIsNamed) {
  ::setenv("PATH", (folder_ / "bin").c_str(), 1);
  EXPECT_FALSE(has_ffmpeg());
  const std::string message = failure_of([&] { const Video video(target(), 64, 48, 25); });
  EXPECT_NE(message.find("ffmpeg cannot be started: No such file or directory"), std::string::npos) << message;
  install("true");
  EXPECT_TRUE(has_ffmpeg());
}

TEST(VideoNames, HaveASuffix) {
  EXPECT_TRUE(is_video("a.mp4"));
  EXPECT_TRUE(is_video("b/a.webm"));
  EXPECT_TRUE(is_video("a.gif"));
  EXPECT_FALSE(is_video("a.png"));
  EXPECT_FALSE(is_video("mp4"));
}

}  // namespace
}  // namespace cadt::viewer
