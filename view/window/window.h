// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A window with Dear ImGui in it, or, offscreen, the picture of one in memory. It draws with a small Vulkan
// device of its own (gpu/present), so that it stays alive while the simulation's device is busy for a whole
// tick, and when that device is lost. All functions belong to the thread that opened the window.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/record.h"

namespace greatx::view {

struct WindowOptions {
  std::string title = "greatx";
  int width = 1280, height = 720;  ///< of the content, in screen coordinates
  bool offscreen = false;          ///< no display is needed
  double scale = 0.0;              ///< of fonts and spaces; 0: as the display asks for
  bool validation = false;         ///< of the window's own device
  std::string device;              ///< index or part of the name of a device; empty: as gpu::choose_device()
  std::string settings_file;       ///< where ImGui keeps what the user arranged; empty: nowhere
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

/// A picture that ImGui::Image() shows: an ImTextureID.
using TextureId = void*;

class Window {
 public:
  /// Throws UserError if there is no display (the message names --offscreen) or no device for it.
  static std::unique_ptr<Window> open(const WindowOptions& options);
  virtual ~Window() = default;

  /// Waits at most `wait_s` for input, takes it, and begins an ImGui frame. Returns false if the user has
  /// closed the window; no frame has begun then.
  virtual bool begin_frame(double wait_s) = 0;
  /// Draws the ImGui frame and presents it. Re-creates the swapchain where it must. A minimised window draws
  /// nothing.
  virtual void end_frame() = 0;
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

  /// Makes a texture of u8 [h, w, 3] or [h, w, 4] texels. The size is fixed.
  virtual TextureId make_texture(const Array& picture) = 0;
  /// Replaces the texels, which the next end_frame() shows. The size must be the texture's.
  virtual void update_texture(TextureId texture, const Array& picture) = 0;
  virtual void drop_texture(TextureId texture) = 0;
};

}  // namespace greatx::view
