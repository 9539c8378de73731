#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/skipped.py LOG...: which tests were skipped, by reason, and how many.

LOG: what ctest has written with --output-junit FILE.xml, or a test program with --gtest_output=json:FILE.json. A file
that is not there is an error, not nothing.
"""
import collections
import json
import re
import sys
import xml.etree.ElementTree


def of_ctest(root):
    """Yields (test, reason)."""
    for case in root.iter("testcase"):
        output = case.findtext("system-out") or ""
        lines = output.strip().splitlines()
        told = re.search(r"(?m)^\S+:\d+: Skipped\n(.*)$", output)
        cases = re.search(r"(?m)^OK \(skipped=(\d+)\)$", output)
        if case.find("skipped") is not None:
            yield case.get("name"), told[1] if told else lines[-1] if lines else "no reason given"
        elif cases:  # some of a script's cases
            reasons = re.findall(r"skipped ['\"](.*)['\"]$", output, re.MULTILINE) or ["no reason given"]
            for i in range(int(cases[1])):
                yield case.get("name"), reasons[min(i, len(reasons) - 1)]
        else:
            for line in sorted(set(re.findall(r"(?m)^NOT TESTED: (.*)$", output))):
                yield case.get("name"), line


def of_gtest(report):
    for suite in report["testsuites"]:
        for test in suite["testsuite"]:
            if test.get("result") == "SKIPPED":
                messages = [entry.get("message", "") for entry in test.get("skipped", [])]
                yield f"{suite['name']}.{test['name']}", (messages or ["no reason given"])[0].strip().split("\n")[-1]


def main():
    skipped = collections.defaultdict(list)
    for path in sys.argv[1:]:
        try:
            with open(path, encoding="utf-8", errors="replace") as stream:
                text = stream.read()
            found = (of_gtest(json.loads(text)) if path.endswith(".json")
                     else of_ctest(xml.etree.ElementTree.fromstring(text)))
            found = list(found)
        except (OSError, ValueError, KeyError, xml.etree.ElementTree.ParseError) as error:
            sys.exit(f"skipped: {path}: {error}")
        for test, reason in found:
            skipped[reason].append(test)
    print(f"{sum(map(len, skipped.values()))} tests skipped")
    for reason, tests in sorted(skipped.items(), key=lambda item: -len(item[1])):
        shown = ", ".join(tests[:3]) + (f" and {len(tests) - 3} more" if len(tests) > 3 else "")
        print(f"  {len(tests):4d}  {reason.strip()}: {shown}")


if __name__ == "__main__":
    main()
