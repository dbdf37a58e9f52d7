// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/message.hpp"

#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>
#include <cadt/io/points_file.hpp>

#include "viewer/gl/errors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <stdexcept>

namespace cadt::viewer {

Message explain(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const io::FileError& e) {
    std::string formats;
    for (const std::string& format : io::point_read_formats()) formats.append(" ").append(format);
    return {"This file cannot be shown", e.what(),
            "Points are read from:" + formats + ". Check the file, then press R to read it again."};
  } catch (const InputError& e) {
    return {"These points have no triangulation", fmt::format("Point {} (counted from 0): {}.", e.index(), e.what()),
            "Correct the file, then press R to read it again."};
  } catch (const LimitError& e) {
    return {"Too many points",
            fmt::format("{}: {} points, at most {}.", e.what(), number_text(e.count()), number_text(e.limit())),
            "Show fewer points, or split them into tiles."};
  } catch (const OptionError& e) {
    return {"A setting is out of range", e.what(), "Change it in the panel, then press R."};
  } catch (const BackendUnavailable& e) {
    return {"The back end is not available", e.what(),
            "Choose another in the panel; `cadt devices` lists what there is."};
  } catch (const KernelBuildError& e) {
    return {"The driver cannot compile the kernels", e.what(),
            "Update the driver, or choose the back end host in the panel."};
  } catch (const DeviceError& e) {
    return {"The device reported an error", e.what(), "Press R to try again, or choose another device in the panel."};
  } catch (const OutOfMemory& e) {
    Message message{"Not enough memory",
                    fmt::format("{}\nNeeded: {}. Available: {}.", e.what(), human_bytes(e.needed()),
                                e.available() == 0 ? "not known" : human_bytes(e.available())),
                    "Show fewer points, close other programs, or choose another device in the panel."};
    message.memory = true;
    return message;
  } catch (const Cancelled&) {
    return {"Cancelled", "What was shown before is still there.", "Press R to start again.", false};
  } catch (const DisplayError& e) {
    return {"The display cannot show this", e.what(), ""};
  } catch (const std::bad_alloc&) {
    Message message{"Not enough memory", "The system gives this program no more memory.",
                    "Show fewer points, or close other programs."};
    message.memory = true;
    return message;
  } catch (const std::exception& e) {
    return {"A defect of cadt", e.what(), "Please report it, with the file and what you did."};
  } catch (...) {
    return {"A defect of cadt", "unknown exception", "Please report it, with the file and what you did."};
  }
}

std::string number_text(std::size_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, 1, ',');
  return text;
}

std::size_t parse_number(const std::string& given) {
  std::string text = given;
  std::erase_if(text, [](char c) { return c == ',' || c == ' ' || c == '_'; });
  double factor = 1;
  if (!text.empty()) {
    const char last = static_cast<char>(text.back() | 32);
    factor = last == 'k' ? 1e3 : last == 'm' ? 1e6 : last == 'g' ? 1e9 : 1;
    if (factor != 1) text.pop_back();
  }
  double value = -1;
  std::size_t used = 0;
  try {
    value = std::stod(text, &used) * factor;
  } catch (const std::exception&) {  // no number, or beyond the largest double
  }
  if (used != text.size() || !(value >= 0) || value != std::floor(value) || value > 1e18)
    throw std::invalid_argument(fmt::format("'{}' is no number of points: write 250000, 2M or 1e6", given));
  return static_cast<std::size_t>(value);
}

}  // namespace cadt::viewer
