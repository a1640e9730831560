"""``get_package_share_directory`` from a table beside the corpus, or by a folder's name."""

import os


def get_package_share_directory(name):
    root = os.environ["PACKAGE_ROOTS"]
    beside = os.path.join(root, name)
    if os.path.isdir(beside):
        return beside
    with open(os.path.join(root, "PACKAGE_ROOTS.tsv")) as table:
        for line in table:
            package, folder, _ = line.rstrip("\n").split("\t")
            if package == name:
                return os.path.join(root, folder)
    raise LookupError(name)
