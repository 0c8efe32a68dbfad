// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A window with Dear ImGui in it, or, offscreen, the picture of one in memory. It draws with a small Vulkan
// device of its own (gpu/present), so that it stays alive while the simulation's device is busy for a whole
// tick, and when that device is lost. All functions belong to the thread that opened the window.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/record.h"

namespace greatx::view {

/// Something that is lost on purpose, for tests.
struct WindowFault {
  enum class Kind : uint8_t { device_lost, surface_lost, out_of_date };
  Kind kind = Kind::device_lost;
  uint64_t frame = 0;  ///< counted from 0
};

struct WindowOptions {
  std::string title = "greatx";
  int width = 1280, height = 720;  ///< of the content, in screen coordinates
  bool offscreen = false;          ///< no display is needed
  bool wall_clock = false;         ///< offscreen: time goes on as outside, not by a sixtieth of a second
  double scale = 0.0;              ///< of fonts and spaces; 0: as the display asks for
  bool validation = false;         ///< of the window's own device
  std::string device;              ///< index or part of the name of a device; empty: as gpu::choose_device()
  std::string settings_file;       ///< where ImGui keeps what the user arranged; empty: nowhere
  std::vector<WindowFault> faults;
};

/// An input from a script. Coordinates are pixels of the window from its upper left corner.
struct InputEvent {
  enum class Kind : uint8_t {
    move,
    press,
    release,
    wheel,
    key_down,
    key_up,
    text,
    resize,
    minimize,
    restore,
    scale
  };
  Kind kind = Kind::move;
  double x = 0.0, y = 0.0;  ///< of move; of wheel: its turns; of resize: the new size;
                            ///< of scale: the new one, as of another display
  int button = 0;           ///< of press and release: 0 left, 1 right, 2 middle
  int key = 0;              ///< of key_down and key_up: GLFW's key code
  bool control = false, shift = false, alt = false;  ///< held with a key
  std::string text;
};

/// Says when a frame begins.
struct FrameWait {
  double most_s = 0.0;  ///< for input or news
  /// Input begins a frame so long after the last one at the soonest.
  double input_after_s = 0.0;
  /// Whether there is something new to show, which begins a frame at once. It is asked every few
  /// milliseconds. Empty: there is none.
  std::function<bool()> news;
};

/// A picture that ImGui::Image() shows: an ImTextureID.
using TextureId = void*;

class Window {
 public:
  /// Throws UserError if there is no display (the message names --offscreen) or no device for it.
  static std::unique_ptr<Window> open(const WindowOptions& options);
  virtual ~Window() = default;

  /// Waits for input or news, takes the input, and begins an ImGui frame. Returns false if the user has
  /// closed the window; no frame has begun then.
  virtual bool begin_frame(const FrameWait& wait) = 0;
  /// Draws the ImGui frame and presents it. Re-creates the swapchain where it must, and surface and device if
  /// one of them is lost. Throws runtime_error if they are lost again and again. A minimised window draws
  /// nothing.
  virtual void end_frame() = 0;
  /// Waits until the last frame is drawn.
  virtual void finish() = 0;
  /// The picture of the last frame drawn, u8 [height, width, 3]. `begin_frame` and `end_frame` must have been
  /// called once.
  virtual Array screenshot() = 0;
  /// Takes an input as if it came from the user, at the next begin_frame.
  virtual void inject(const InputEvent& event) = 0;
  /// Returns the messages of the validation layer since the last call; none without validation.
  virtual std::vector<std::string> validation_messages() = 0;
  virtual void set_title(const std::string& title) = 0;
  virtual bool minimized() const = 0;
  /// Pixels for each screen coordinate, for fonts (1 or more).
  virtual double pixel_scale() const = 0;
  virtual int width() const = 0;   ///< pixels
  virtual int height() const = 0;  ///< pixels

  /// Makes a texture of u8 [h, w, 3] or [h, w, 4] texels. The size is fixed. One of three channels is opaque.
  virtual TextureId make_texture(const Array& picture) = 0;
  /// Replaces the texels, which the next end_frame() shows. The size must be the texture's.
  virtual void update_texture(TextureId texture, const Array& picture) = 0;
  virtual void drop_texture(TextureId texture) = 0;
};

}  // namespace greatx::view
