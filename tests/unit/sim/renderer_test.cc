// Pictures without a window: something is drawn, it follows the configuration, errors are clear.
#include "sim/view/renderer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "sim/view/video.h"

namespace footfall::sim {
namespace {

constexpr const char* kLeg = R"(<mujoco>
  <worldbody>
    <body name="torso" pos="0 0 0.8">
      <freejoint name="base"/>
      <geom type="box" size="0.1 0.1 0.2" rgba="0.8 0.1 0.1 1"/>
      <body name="thigh">
        <joint name="knee" axis="0 1 0"/>
        <geom type="capsule" size="0.05" fromto="0 0 -0.2 0 0 -0.7"/>
      </body>
    </body>
  </worldbody>
</mujoco>)";

std::string leg_file() {
  // One file a test: they may run side by side.
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path =
      std::filesystem::path(testing::TempDir()) / (std::to_string(getpid()) + test + ".xml");
  std::ofstream(path) << kLeg;
  return path.string();
}

std::string error_of(const std::string& mjcf) {
  try {
    const FilmRenderer renderer(mjcf, 64, 64);
    return "no error";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(Film, APictureShowsMoreThanOneColour) {
  FilmRenderer renderer(leg_file(), 160, 200);
  const Image image = renderer.render({renderer.neutral(), "0.00 s", "stand", {}});
  ASSERT_EQ(image.rgb.size(), 3U * 160U * 200U);
  std::set<std::array<std::uint8_t, 3>> colours;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    colours.insert({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
  }
  EXPECT_GT(colours.size(), 50U);  // sky, floor, shadow, the red torso in many shades
}

TEST(Film, TheRobotIsAboveItsFloorAndTheSkyAboveAll) {
  FilmRenderer renderer(leg_file(), 160, 200);
  const Image image = renderer.render({renderer.neutral(), "", "", {}});
  const auto red_rows = [&] {
    std::vector<int> rows;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const auto* p = &image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
        if (p[0] > 2 * p[1] && p[0] > 60) rows.push_back(y);
      }
    }
    return rows;
  }();
  ASSERT_FALSE(red_rows.empty());
  EXPECT_LT(red_rows[red_rows.size() / 2], 110);  // the torso's middle is in the upper half
}

TEST(Film, AMovedJointAndAForceChangeThePicture) {
  FilmRenderer renderer(leg_file(), 160, 200);
  FilmFrame frame{renderer.neutral(), "", "", {}};
  const Image before = renderer.render(frame);
  EXPECT_EQ(renderer.render(frame).rgb, before.rgb);
  ASSERT_GE(renderer.joint_address("knee"), 0);
  frame.qpos[static_cast<std::size_t>(renderer.joint_address("knee"))] = 1.0;
  const Image bent = renderer.render(frame);
  EXPECT_NE(bent.rgb, before.rgb);
  frame.arrows.push_back({{0, 0, 0.1}, {0, 0, 200}});
  EXPECT_NE(renderer.render(frame).rgb, bent.rgb);
}

TEST(Film, TwoRenderersDoNotDisturbEachOther) {
  FilmRenderer one(leg_file(), 160, 200);
  const Image alone = one.render({one.neutral(), "", "", {}});
  {
    FilmRenderer two(leg_file(), 80, 80);
    two.render({two.neutral(), "", "", {}});
    EXPECT_EQ(one.render({one.neutral(), "", "", {}}).rgb, alone.rgb);
  }
  EXPECT_EQ(one.render({one.neutral(), "", "", {}}).rgb, alone.rgb);
}

TEST(Film, AStripHasItsPicturesInRows) {
  const std::vector<Image> pictures(5, Image(20, 30, 7));
  const Image strip = film_strip(pictures, 3);
  EXPECT_EQ(strip.width, 3 * 20 + 2 * 4);
  EXPECT_EQ(strip.height, 2 * 30 + 4);
  EXPECT_EQ(std::ranges::count(strip.rgb, 7), 5 * 3 * 20 * 30);
}

TEST(Film, AMissingOrMalformedModelIsOneSentence) {
  EXPECT_EQ(error_of("/no/robot.xml"), "cannot render '/no/robot.xml': no such file");
  const auto path = std::filesystem::path(testing::TempDir()) / "footfall_film_bad.xml";
  std::ofstream(path) << "<mujoco><worldbody><geom type='bx'/></worldbody></mujoco>";
  const std::string error = error_of(path.string());
  EXPECT_TRUE(error.starts_with(path.string() + ": error: MuJoCo refuses it: ")) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos);
}

TEST(Film, APictureBecomesAPng) {
  const std::vector<std::uint8_t> png = encode_png(Image(16, 8, 128));
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(std::string(png.begin() + 1, png.begin() + 4), "PNG");
  EXPECT_EQ(png[19], 16);  // width and height, big-endian, in the header chunk
  EXPECT_EQ(png[23], 8);
  EXPECT_THROW(write_png(Image(2, 2), "/no/such/folder/x.png"), std::runtime_error);
}

TEST(Film, AMovieNeedsAPlaceToWrite) {
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {
    EXPECT_THROW(MovieWriter("/tmp/x.mp4", 32, 32, 30.0), std::runtime_error);
    return;
  }
  EXPECT_THROW(MovieWriter("/no/such/folder/x.mp4", 32, 32, 30.0), std::runtime_error);
  const auto path = std::filesystem::path(testing::TempDir()) / "footfall's film.mp4";
  MovieWriter movie(path.string(), 32, 32, 30.0);
  for (int i = 0; i < 5; ++i) movie.add(Image(32, 32, static_cast<std::uint8_t>(40 * i)));
  movie.finish();
  EXPECT_GT(std::filesystem::file_size(path), 100U);
}

}  // namespace
}  // namespace footfall::sim
