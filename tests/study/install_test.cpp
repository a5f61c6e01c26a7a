#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/study/small_scenes.hpp"

/// The installed program finds its own scripts.
namespace palpate::study {
namespace {

using namespace testing;

TEST(Installation, AStudyAndATableOfStabilityMakeTheirPagesByTheScriptsBesideTheProgram) {
  const Folder folder;
  const std::string prefix = (folder.at / "prefix").string();
  ASSERT_EQ(std::system((std::string(PALPATE_CMAKE) + " --install " + PALPATE_BUILD_DIR + " --prefix " + prefix +
                         " --component pages > /dev/null")
                            .c_str()),
            0);
  for (const std::string name : {"study_page.py", "stability_page.py"}) {
    const std::filesystem::path script = folder.at / "prefix/share/palpate/scripts" / name;
    ASSERT_FALSE(text_of(script).empty());
    EXPECT_EQ(text_of(script), text_of(std::filesystem::path(PALPATE_SOURCE_DIR) / "scripts" / name));
    std::ofstream(script)
        << "import pathlib, sys\n(pathlib.Path(sys.argv[1]) / 'index.html').write_text('of the installation')\n";
  }
  const Scene scene = catheter_scene(folder.at, 10);
  const std::string program = prefix + "/bin/palpate", study = (folder.at / "study").string(),
                    stability = (folder.at / "stability").string();
  ASSERT_EQ(std::system((program + " study " + scene.file.string() + " --quick -o " + study + " > /dev/null").c_str()),
            0);
  EXPECT_EQ(text_of(folder.at / "study/index.html"), "of the installation");
  ASSERT_EQ(std::system((program + " stability --quick --only curve -o " + stability + " 2> /dev/null").c_str()), 0);
  EXPECT_EQ(text_of(folder.at / "stability/index.html"), "of the installation");
}

}  // namespace
}  // namespace palpate::study
