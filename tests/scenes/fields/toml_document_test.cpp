#include "scenes/fields/toml_document.h"

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::toml_document_test {
namespace {

const SourcePlace command_line = {.file = "--set key"};

TomlNode value_of(const std::string& text) { return parse_toml_value(text, command_line); }

}  // namespace

TEST_CASE("a document becomes a tree of kinds and values") {
    const TomlNode document =
        parse_toml("a = 1\nb = 2.5\nc = \"x\"\nd = true\ne = [1, [2]]\nf = 2024-01-01\n[g.h]\ni = 3\n", "t");
    REQUIRE(document.kind == TomlKind::table);
    CHECK(document.find("a")->kind == TomlKind::integer);
    CHECK(document.find("a")->integer == 1);
    CHECK(document.find("a")->number == 1.0);
    CHECK(document.find("b")->kind == TomlKind::number);
    CHECK(document.find("b")->number == 2.5);
    CHECK(document.find("c")->text == "x");
    CHECK(document.find("d")->kind == TomlKind::boolean);
    CHECK(document.find("e")->items.at(1).items.at(0).integer == 2);
    CHECK(document.find("f")->kind == TomlKind::date);
    CHECK(document.find("g")->find("h")->find("i")->integer == 3);
    CHECK(document.find("z") == nullptr);
}

TEST_CASE("keys and values know their lines and columns") {
    const TomlNode document = parse_toml("first = 1\n\n[table]\n  second = \"x\"\n", "file.toml");
    const TomlNode& second = *document.find("table")->find("second");
    CHECK(second.key_place.file == "file.toml");
    CHECK(second.key_place.line == 4);
    CHECK(second.key_place.column == 3);
    CHECK(second.place.line == 4);
    CHECK(second.place.column == 12);
}

TEST_CASE("entries keep the order of the document") {
    const TomlNode document = parse_toml("z = 1\na = 2\n[m]\nx = 1\n[b]\n", "t");
    REQUIRE(document.entries.size() == 4);
    CHECK(document.entries[0].key == "z");
    CHECK(document.entries[1].key == "a");
    CHECK(document.entries[2].key == "m");
    CHECK(document.entries[3].key == "b");
}

TEST_CASE("tables in double brackets become a list of tables in their order") {
    const TomlNode document = parse_toml("[[cloth]]\nname = \"b\"\n[[cloth]]\nname = \"a\"\n", "t");
    const TomlNode& list = *document.find("cloth");
    REQUIRE(list.kind == TomlKind::list);
    REQUIRE(list.items.size() == 2);
    CHECK(list.items[0].find("name")->text == "b");
    CHECK(list.items[1].find("name")->text == "a");
    CHECK(list.items[1].place.line == 3);
}

TEST_CASE("text that is not TOML is an error with file, line and column") {
    CHECK(error_of([] { parse_toml("a = 1\nb = [1, 2\n", "file.toml"); }).starts_with("file.toml:"));
    CHECK(error_of([] { parse_toml("a = 1\nb 2\n", "file.toml"); }).starts_with("file.toml:2:3: not valid TOML"));
    CHECK(error_of([] { parse_toml("a = 1\nb = 0,005  # m\n", "f"); }).ends_with("; decimals take a point: 0.005"));
    CHECK(error_of([] { parse_toml("b = 5mm\n", "f"); }).ends_with("; a number is written without its unit, in m: 0.005"));
    CHECK(error_of([] { parse_toml("a = 1\na = 2\n", "file.toml"); }).starts_with("file.toml:2:"));
    CHECK(error_of([] { parse_toml("a = \"\xff\"\n", "file.toml"); }).starts_with("file.toml:1:"));
    CHECK(error_of([] { parse_toml(std::string("a = \0", 5), "file.toml"); }).starts_with("file.toml:1:"));
    CHECK(error_of([] { parse_toml("a = " + std::string(5000, '['), "file.toml"); }).starts_with("file.toml:1:"));
}

TEST_CASE("a key of very many parts is refused instead of exhausting the stack, dots elsewhere are not counted") {
    std::string deep = "a", dotted = "a";
    for (int i = 0; i < 100000; ++i) deep += ".a";
    for (int i = 0; i < 256; ++i) dotted += ".a";
    CHECK(error_of([&] { parse_toml("x = 1\n[" + deep + "]\n", "t"); }) == "t:2:1: a key with more than 256 dots");
    CHECK(error_of([&] { parse_toml(deep + " = 1\n", "t"); }) == "t:1:1: a key with more than 256 dots");
    CHECK(parse_toml(dotted + " = 1\n", "t").entries.size() == 1);
    CHECK(error_of([&] { value_of("{ " + deep + " = 1 }"); }).find("more than 256 dots") != std::string::npos);
    std::string numbers = "x = [0.5";
    for (int i = 0; i < 1000; ++i) numbers += ", 0.5";
    CHECK(parse_toml("# " + std::string(1000, '.') + "\n" + numbers + "]\n", "t").find("x")->items.size() == 1001);
}

TEST_CASE("a value from the command line is TOML where it can be") {
    CHECK(value_of("3").integer == 3);
    CHECK(value_of("1e-3").number == 1e-3);
    CHECK(value_of("true").kind == TomlKind::boolean);
    CHECK(value_of("\"3\"").text == "3");
    CHECK(value_of("[1, 2]").items.size() == 2);
    CHECK(value_of("{ below = 0.5 }").find("below")->number == 0.5);
}

TEST_CASE("a bare word from the command line is a text") {
    CHECK(value_of("brute_force").kind == TomlKind::text);
    CHECK(value_of("brute_force").text == "brute_force");
    CHECK(value_of("two words").text == "two words");
    CHECK(value_of("a/b.obj").text == "a/b.obj");
}

TEST_CASE("everything in a value from the command line has the command line as its place") {
    const TomlNode value = value_of("{ box = [[0, 0, 0], [1, 1, 1]] }");
    CHECK(value.place.file == "--set key");
    const TomlNode& deep = value.find("box")->items[1].items[2];
    CHECK(deep.place.file == "--set key");
    CHECK(deep.place.line == 0);
}

TEST_CASE("an empty, broken or two-line value from the command line is an error") {
    CHECK(error_of([] { value_of(""); }) == "--set key: the value is empty");
    CHECK(error_of([] { value_of("  "); }) == "--set key: the value is empty");
    CHECK(error_of([] { value_of("[1, 2"); }).starts_with("--set key: not a valid TOML value"));
    CHECK(error_of([] { value_of("\"abc"); }).starts_with("--set key: not a valid TOML value"));
    CHECK(error_of([] { value_of("1\nduration = 3"); }) == "--set key: the value must be on one line");
}

TEST_CASE("descriptions say kind and value") {
    const TomlNode d = parse_toml("a = 1\nb = 2.5\nc = \"x\"\nd = true\ne = [1, 2]\nf = 2024-01-01\ng = {}\n", "t");
    CHECK(described(*d.find("a")) == "the number 1");
    CHECK(described(*d.find("b")) == "the number 2.5");
    CHECK(described(*d.find("c")) == "the text \"x\"");
    CHECK(described(*d.find("d")) == "true");
    CHECK(described(*d.find("e")) == "a list of 2");
    CHECK(described(*d.find("f")) == "a date or time");
    CHECK(described(*d.find("g")) == "a table");
}

}  // namespace percale::scenes::test::toml_document_test
