"use strict";

const assert = require("node:assert");
const test = require("node:test");
const { selectRobots } = require("../dist-test/robots.js");

const LISTING = `/w/arm.urdf.xacro  (by its name)
  with prefix:=left_
  includes /w/link.macro.xacro
/w/rover.urdf.xacro  (by its name)
  includes /w/link.macro.xacro
  includes /w/wheel.xacro
/w/other.xacro  (no robot includes it)
`;

test("robots that include a file", () => {
  const found = (name) => selectRobots(LISTING, `/w/${name}`, "/w");
  assert.deepStrictEqual(found("link.macro.xacro"), ["/w/arm.urdf.xacro", "/w/rover.urdf.xacro"]);
  assert.deepStrictEqual(found("wheel.xacro"), ["/w/rover.urdf.xacro"]);
  assert.deepStrictEqual(found("arm.urdf.xacro"), ["/w/arm.urdf.xacro"]);
  assert.deepStrictEqual(found("other.xacro"), []);
});
