#include "tools/volume/label_names.h"

#include <catch2/catch.hpp>

#include "tests/tools/tool_fixtures.h"

namespace {

using Catch::Matchers::Contains;
using fixtures::failure_of;
using fixtures::Folder;
using plc::tools::label_names_beside;
using plc::tools::LabelEntries;
using plc::tools::read_label_names;
using Rgb = std::array<uint8_t, 3>;

LabelEntries names_of(const std::string& text) {
  const Folder folder;
  return read_label_names(folder.put("names.txt", text));
}

std::string refusal(const std::string& text) {
  return failure_of([&] { names_of(text); });
}

}  // namespace

TEST_CASE("names and colours are read from the tables of every program", "[label_names]") {
  const LabelEntries freesurfer = names_of(
      "#No. Label Name:  R   G   B   A\n\n0   Unknown    0   0   0   0\n"
      "4   Left-Lateral-Ventricle  120 18  134 0\r\n1004 a name of words 25 100 40 0\n");
  CHECK(freesurfer.at(4).name == "Left-Lateral-Ventricle");
  CHECK(freesurfer.at(4).rgb == Rgb{120, 18, 134});
  CHECK(freesurfer.at(1004).name == "a name of words");
  const LabelEntries snap = names_of("# ITK-SnAP\n 7 236 13 176 1 1 1 \"Left Putamen\"\n");
  CHECK(snap.at(7).name == "Left Putamen");
  CHECK(snap.at(7).rgb == Rgb{236, 13, 176});
  const LabelEntries slicer = names_of("# Color table file\n1 tissue 128 174 128 255\n");
  CHECK(slicer.at(1).name == "tissue");
  CHECK(slicer.at(1).rgb == Rgb{128, 174, 128});
  const LabelEntries aal = names_of("1 Precentral_L 2001\n2 Precentral_R 2002\n3 Only\n");
  CHECK(aal.at(2).name == "Precentral_R");
  CHECK_FALSE(aal.at(2).rgb);
  CHECK(aal.at(3).name == "Only");
  CHECK(names_of("PUT_L Putamen_L 7011\n").at(7011).name == "Putamen_L");
  std::string lut(768, '\0');
  lut[5] = '\x10', lut[256 + 5] = '\x20', lut[512 + 5] = '\xff';
  CHECK(names_of(lut).at(5).rgb == Rgb{0x10, 0x20, 0xff});
  CHECK(names_of(lut).at(5).name.empty());
  // Of two lines of one label the first counts.
  CHECK(names_of("1 first\n1 second\n").at(1).name == "first");
}

TEST_CASE("what is no table of names is refused with its line", "[label_names]") {
  CHECK_THAT(refusal(""), Contains("names.txt: holds no names"));
  CHECK_THAT(refusal("1 good\nbad\n"), Contains("line 2: begins with \"bad\""));
  CHECK_THAT(refusal("7\n"), Contains("line 1: label 7 has no name"));
  CHECK_THAT(refusal("7 1 2 300 1 1 1 \"x\"\n"), Contains("a colour is \"300\""));
  CHECK_THAT(refusal("7 1 2 3 1 1 1 \"x\n"), Contains("a quote is not closed"));
  CHECK_THAT(refusal("7 bell\a\n"), Contains("control characters"));
  CHECK_THAT(refusal("7 \xff\xfe\n"), Contains("not UTF-8"));
  CHECK_THAT(refusal("7 " + std::string(201, 'a') + "\n"), Contains("at most 200"));
  CHECK_THAT(failure_of([] { read_label_names("missing.txt"); }), Contains("no such file"));
  CHECK_THAT(failure_of([] { read_label_names("/"); }), Contains("is not a file"));
}

TEST_CASE("the tables that lie beside an image are found, names before colours", "[label_names]") {
  const Folder folder;
  const std::string image = folder / "atlas.nii.gz";
  std::vector<std::string> warnings;
  CHECK(label_names_beside(image, warnings).empty());
  std::string lut(768, '\0');
  lut[1] = '\x7f';
  folder.put("atlas.nii.lut", lut);
  folder.put("atlas.nii.txt", "1 One 2001\n");
  LabelEntries found = label_names_beside(image, warnings);
  CHECK(found.at(1).name == "One");
  CHECK(found.at(1).rgb == Rgb{0x7f, 0, 0});
  folder.put("atlas.label", "1 9 8 7 1 1 1 \"of SNAP\"\n");
  CHECK(label_names_beside(image, warnings).at(1).name == "of SNAP");
  CHECK(warnings.empty());
  // One that cannot be read is told, and passed over.
  folder.put("atlas.label", "nonsense\n");
  found = label_names_beside(image, warnings);
  CHECK(found.at(1).name == "One");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("atlas.label: line 1"));
  // FreeSurfer's own, where no table has the image's name.
  const Folder other;
  other.put("FreeSurferColorLUT.txt", "2 White 245 245 245 0\n");
  CHECK(label_names_beside(other / "aseg.mgz.nrrd", warnings).at(2).name == "White");
}
