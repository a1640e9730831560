"""Operations of ``urdftool edit`` on real robots, measured by Pinocchio, and scikit-robot's."""
