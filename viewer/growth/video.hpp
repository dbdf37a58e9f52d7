// SPDX-License-Identifier: Apache-2.0
// A film through the program ffmpeg: pictures go into its pipe, a complete file gets its name.
#pragma once

#include "viewer/draw/renderer.hpp"

#include <string>
#include <string_view>

namespace cadt::viewer {

/// Whether the suffix is that of a film: .mp4, .webm, .gif.
[[nodiscard]] bool is_video(std::string_view path) noexcept;
/// Whether ffmpeg is on the path.
[[nodiscard]] bool has_ffmpeg();

class Video {
 public:
  /// Starts ffmpeg. Width and height are even. \throws io::FileError if ffmpeg cannot be started
  Video(std::string path, int width, int height, double fps);
  /// Without finish() ffmpeg is stopped and nothing stays behind.
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// \pre the picture has the size of the film \throws io::FileError, with ffmpeg's last line, if ffmpeg has ended
  void write(const Image& picture);
  /// Waits for ffmpeg and renames the file. \throws io::FileError, with ffmpeg's exit code and last line
  void finish();

 private:
  [[noreturn]] void fail(int status);
  int wait() noexcept;
  std::string last_line() const;

  std::string path_, temporary_;
  int pipe_ = -1, messages_ = -1, process_ = -1;
};

}  // namespace cadt::viewer
