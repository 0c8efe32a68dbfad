// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The window: what is drawn is what is read back, pixel by pixel, offscreen and on a real display.
#include "view/window/window.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <imgui.h>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace greatx::view {
namespace {

std::unique_ptr<Window> open(bool offscreen, int width = 320, int height = 200,
                             std::vector<WindowFault> faults = {}) {
  WindowOptions options;
  options.faults = std::move(faults);
  options.width = width;
  options.height = height;
  options.offscreen = offscreen;
  options.validation = true;
  return Window::open(options);
}

struct Rgb {
  int r, g, b;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};
Rgb pixel(const Array& picture, int x, int y) {
  const auto at = [&](int c) {
    return static_cast<int>(picture.bytes[static_cast<size_t>((y * picture.shape[1] + x) * 3 + c)]);
  };
  return {at(0), at(1), at(2)};
}

template <typename Draw>
void frame(Window& window, Draw draw) {
  ASSERT_TRUE(window.begin_frame({}));
  draw();
  window.end_frame();
  for (const std::string& message : window.validation_messages()) ADD_FAILURE() << message;
}

void fill(float x0, float y0, float x1, float y1, ImU32 color) {
  ImGui::GetBackgroundDrawList()->AddRectFilled({x0, y0}, {x1, y1}, color);
}

/// [4, 8, 3] with every texel of its own colour.
Array texels(int shift) {
  Array picture(DType::u8, {4, 8, 3});
  for (size_t i = 0; i < picture.bytes.size(); ++i)
    picture.bytes[i] = static_cast<std::byte>((static_cast<int>(i) * 2 + shift) % 256);
  return picture;
}

size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

void draws_exactly(bool offscreen) {
  const auto window = open(offscreen);
  for (int i = 0; i < 3; ++i) frame(*window, [] { fill(10, 20, 30, 50, IM_COL32(255, 128, 64, 255)); });
  const Array picture = window->screenshot();
  ASSERT_EQ(picture.shape, (std::vector<int64_t>{window->height(), window->width(), 3}));
  EXPECT_EQ(pixel(picture, 10, 20), (Rgb{255, 128, 64}));
  EXPECT_EQ(pixel(picture, 29, 49), (Rgb{255, 128, 64}));
  EXPECT_EQ(pixel(picture, 9, 20), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(picture, 30, 49), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(picture, 29, 50), (Rgb{0, 0, 0}));
}

void shows_textures(bool offscreen) {
  const auto window = open(offscreen);
  const TextureId texture = window->make_texture(texels(0));
  const auto shown = [&](int shift) {
    frame(*window, [&] { ImGui::GetBackgroundDrawList()->AddImage(texture, {5, 6}, {13, 10}); });
    const Array picture = window->screenshot();
    const Array wanted = texels(shift);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x)
        EXPECT_EQ(pixel(picture, 5 + x, 6 + y), pixel(wanted, x, y)) << x << ' ' << y;
  };
  shown(0);
  window->update_texture(texture, texels(77));
  shown(77);
  shown(77);
  window->drop_texture(texture);  // while frames with it may be in flight
  for (int i = 0; i < 4; ++i) frame(*window, [] {});
}

void takes_input(bool offscreen) {
  const auto window = open(offscreen);
  int pressed = 0;
  char typed[32] = "";
  bool key = false, focus = false;
  const auto draw = [&] {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({300, 180});
    ImGui::Begin("w", nullptr, ImGuiWindowFlags_NoTitleBar);
    if (ImGui::Button("press", {100, 30})) ++pressed;
    if (std::exchange(focus, false)) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("text", typed, sizeof typed);
    key |= ImGui::IsKeyPressed('K', false);
    ImGui::End();
  };
  for (int i = 0; i < 2; ++i) frame(*window, draw);
  const auto mouse = [&](InputEvent::Kind kind) {
    InputEvent event;
    event.kind = kind;
    event.x = 50;
    event.y = 20;
    window->inject(event);
    frame(*window, draw);
  };
  mouse(InputEvent::Kind::move);
  mouse(InputEvent::Kind::press);
  mouse(InputEvent::Kind::release);
  frame(*window, draw);
  EXPECT_EQ(pressed, 1);
  focus = true;
  for (int i = 0; i < 3; ++i) frame(*window, draw);
  InputEvent text;
  text.kind = InputEvent::Kind::text;
  text.text = "abc";
  window->inject(text);
  for (int i = 0; i < 3; ++i) frame(*window, draw);
  EXPECT_STREQ(typed, "abc");
  InputEvent down;
  down.kind = InputEvent::Kind::key_down;
  down.key = 'K';
  window->inject(down);
  frame(*window, draw);
  EXPECT_TRUE(key);
}

void resizes(bool offscreen) {
  const auto window = open(offscreen);
  for (const auto& [width, height] : {std::pair(500, 300), std::pair(200, 150), std::pair(640, 480)}) {
    InputEvent resize;
    resize.kind = InputEvent::Kind::resize;
    resize.x = width;
    resize.y = height;
    window->inject(resize);
    for (int i = 0; i < 20 && (window->width() != width || i < 3); ++i)
      frame(*window, [] { fill(0, 0, 50, 50, IM_COL32(1, 2, 3, 255)); });
    const Array picture = window->screenshot();
    EXPECT_EQ(picture.shape, (std::vector<int64_t>{height, width, 3}));
    EXPECT_EQ(pixel(picture, 49, 49), (Rgb{1, 2, 3}));
  }
}

void minimizes(bool offscreen) {
  const auto window = open(offscreen);
  frame(*window, [] {});
  InputEvent event;
  event.kind = InputEvent::Kind::minimize;
  window->inject(event);
  for (int i = 0; i < 5; ++i) frame(*window, [] { fill(0, 0, 9, 9, IM_COL32_WHITE); });
  event.kind = InputEvent::Kind::restore;
  window->inject(event);
  for (int i = 0; i < 5; ++i) frame(*window, [] { fill(0, 0, 9, 9, IM_COL32_WHITE); });
  EXPECT_FALSE(window->minimized());
  EXPECT_EQ(pixel(window->screenshot(), 4, 4), (Rgb{255, 255, 255}));
}

/// Draws text, a texture of each kind and rectangles that change; it does not look at the time.
void busy_drawing(int i, const TextureId (&textures)[2]) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto at = [&](int n, int most) { return static_cast<float>((n * 37 + 11) % most); };
  for (int n = 0; n < 12; ++n)
    list.AddRectFilled({at(n, 250), at(n + 3, 150)}, {at(n, 250) + 40.0f, at(n + 3, 150) + 25.0f},
                       IM_COL32(20 * n, 200 - 9 * n, n == i % 12 ? 255 : 30, 200));
  list.AddImage(textures[0], {60, 40}, {220, 160});  // opaque: what is below need not be drawn
  list.AddImage(textures[1], {at(i / 3, 200), 20}, {at(i / 3, 200) + 64.0f, 52});
  list.AddText({80, 60}, IM_COL32_WHITE, std::to_string(i / 2).c_str());
  if (i % 5 == 0) list.AddLine({0, 0}, {300, 190}, IM_COL32(255, 0, 0, 255), 3.0f);
  ImGui::SetNextWindowPos({100, 90});
  ImGui::SetNextWindowSize({90, 60});
  ImGui::Begin("w", nullptr, ImGuiWindowFlags_NoTitleBar);
  ImGui::Text("%d", i);
  ImGui::End();
}

/// [4, 8, 4] with texels that let through what is below.
Array veil(int shift) {
  Array picture(DType::u8, {4, 8, 4});
  for (size_t i = 0; i < picture.bytes.size(); ++i)
    picture.bytes[i] = static_cast<std::byte>((static_cast<int>(i) * 5 + shift) % 256);
  return picture;
}

TEST(Window, DrawingWhatHasChangedIsDrawingAll) {
  const auto window = open(true);
  const TextureId textures[] = {window->make_texture(texels(0)), window->make_texture(veil(0))};
  for (int i = 0; i < 40; ++i) {
    if (i % 4 == 0) window->update_texture(textures[0], texels(i));
    if (i % 7 == 0) window->update_texture(textures[1], veil(i));
    frame(*window, [&] { busy_drawing(i, textures); });
    if (i < 3 || i % 3 != 0) continue;
    const Array parts = window->screenshot();
    // Another size makes the next frames new in all parts.
    InputEvent resize;
    resize.kind = InputEvent::Kind::resize;
    for (const int width : {321, 320}) {
      resize.x = width;
      resize.y = 200;
      window->inject(resize);
      frame(*window, [&] { busy_drawing(i, textures); });
    }
    EXPECT_TRUE(window->screenshot().bytes == parts.bytes) << "frame " << i;
  }
}

/// Draws over some faults, and expects the texture to be there after each.
void survives(bool offscreen, std::vector<WindowFault> faults) {
  const auto window = open(offscreen, 320, 200, std::move(faults));
  const TextureId first = window->make_texture(texels(0));
  window->drop_texture(first);
  const TextureId texture = window->make_texture(texels(5));
  const Array wanted = texels(5);
  for (int i = 0; i < 12; ++i) {
    frame(*window, [&] {
      ImGui::GetBackgroundDrawList()->AddImage(texture, {5, 6}, {13, 10});
      ImGui::GetBackgroundDrawList()->AddText({40, 40}, IM_COL32_WHITE, "text");
    });
    const Array picture = window->screenshot();
    ASSERT_EQ(pixel(picture, 5 + 7, 6 + 3), pixel(wanted, 7, 3)) << "frame " << i;
    int bright = 0;
    for (int x = 40; x < 70; ++x)
      for (int y = 40; y < 56; ++y) bright += pixel(picture, x, y).r > 128;
    EXPECT_GT(bright, 10) << "the font, frame " << i;
  }
}
constexpr WindowFault::Kind device_lost = WindowFault::Kind::device_lost,
                            surface_lost = WindowFault::Kind::surface_lost,
                            out_of_date = WindowFault::Kind::out_of_date;

TEST(Window, SurvivesALostDevice) { survives(true, {{device_lost, 0}, {device_lost, 4}, {device_lost, 5}}); }

TEST(Window, ADeviceThatIsLostAgainAndAgainIsAnError) {
  const auto window =
      open(true, 320, 200, {{device_lost, 2}, {device_lost, 3}, {device_lost, 4}, {device_lost, 5}});
  for (int i = 0; i < 2; ++i) frame(*window, [] {});
  ASSERT_TRUE(window->begin_frame({}));
  try {
    window->end_frame();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("lost after 3 attempts"),
                                             testing::HasSubstr("VK_ERROR_DEVICE_LOST")));
  }
}

TEST(Window, DrawsExactly) { draws_exactly(true); }
TEST(Window, ShowsTextures) { shows_textures(true); }
TEST(Window, TakesInput) { takes_input(true); }
TEST(Window, Resizes) { resizes(true); }
TEST(Window, Minimizes) { minimizes(true); }

TEST(Window, FontsAndSpacesFollowTheScale) {
  WindowOptions options;
  options.offscreen = options.validation = true;
  options.scale = 2.0;
  const auto window = Window::open(options);
  EXPECT_EQ(window->pixel_scale(), 2.0);
  float font = 0.0f, space = 0.0f;
  const auto measure = [&] {
    frame(*window, [&] {
      ImGui::Begin("w");
      ImGui::TextUnformatted("text");
      font = ImGui::GetFontSize();
      space = ImGui::GetStyle().ItemSpacing.x;
      ImGui::End();
    });
  };
  measure();
  EXPECT_EQ(font, 30.0f);
  EXPECT_EQ(space, 12.0f);
  for (const double scale : {1.0, 1.5, 1.0}) {  // as if the window went from display to display
    InputEvent event;
    event.kind = InputEvent::Kind::scale;
    event.x = scale;
    window->inject(event);
    for (int i = 0; i < 3; ++i) measure();
    EXPECT_NEAR(font, 15.0 * scale, 0.6);
    EXPECT_EQ(space, std::floor(6.0 * scale));
  }
}

TEST(Window, ManyFramesDoNotGrow) {
  const auto window = open(true, 160, 120);
  TextureId texture = window->make_texture(texels(0));
  const auto run = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      window->update_texture(texture, texels(i));
      if (i % 10 == 9) {
        window->drop_texture(texture);
        texture = window->make_texture(texels(i));
      }
      frame(*window, [&] { ImGui::GetBackgroundDrawList()->AddImage(texture, {0, 0}, {80, 40}); });
    }
  };
  run(200);
  const size_t before = resident_bytes();
  run(1000);
  EXPECT_LT(resident_bytes(), before + (size_t{8} << 20));
}

TEST(Window, WithoutADisplayTheErrorNamesTheWayOut) {
  if (std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr)
    GTEST_SKIP() << "there is a display";
  try {
    open(false);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("no display"), testing::HasSubstr("--offscreen")));
  }
}

/// With a display: CMake runs these under Xvfb.
class RealWindow : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("GREATX_TEST_DISPLAY") == nullptr) GTEST_SKIP() << "runs under Xvfb, as view_window_x11";
  }
};
TEST_F(RealWindow, DrawsExactly) { draws_exactly(false); }
TEST_F(RealWindow, ShowsTextures) { shows_textures(false); }
TEST_F(RealWindow, TakesInput) { takes_input(false); }
TEST_F(RealWindow, Resizes) { resizes(false); }
TEST_F(RealWindow, Minimizes) { minimizes(false); }
TEST_F(RealWindow, SurvivesALostDevice) { survives(false, {{device_lost, 0}, {device_lost, 4}}); }
TEST_F(RealWindow, SurvivesALostSurface) { survives(false, {{surface_lost, 0}, {surface_lost, 5}}); }
TEST_F(RealWindow, SurvivesASwapchainThatIsOutOfDate) {
  survives(false, {{out_of_date, 1}, {out_of_date, 2}, {out_of_date, 6}});
}

}  // namespace
}  // namespace greatx::view
