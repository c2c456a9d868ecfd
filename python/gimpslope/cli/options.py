"""Options that several commands have."""

from __future__ import annotations

import argparse

from ..studies import reference

_MODELS = (
    "deformable: 20e9 Pa, the paper's (the default); softened: 0.5e9 Pa, a sixth of the steps; "
    "rigid: each stone moves as one, the steps of soil alone"
)


def add_stone_model(parser: argparse._ActionsContainer) -> None:
    """`--stone-model`, `--stone-modulus` and `--stone-friction`, None where left out."""
    parser.add_argument(
        "--stone-model",
        choices=list(reference.STONE_MODELS),
        help=_MODELS,
    )
    parser.add_argument(
        "--stone-modulus",
        type=float,
        metavar="PA",
        help="Young's modulus of the stones, Pa, in place of the model's",
    )
    parser.add_argument(
        "--stone-friction",
        type=float,
        metavar="DEG",
        help="angle of friction of rigid stones along soil and each other, degrees (default: soil "
        "sticks to them)",
    )


def add_stone_models(parser: argparse.ArgumentParser) -> None:
    """`--stone-model`, one or more; None where left out."""
    parser.add_argument(
        "--stone-model", nargs="+", choices=list(reference.STONE_MODELS), help=_MODELS
    )


def add_readings(parser: argparse.ArgumentParser) -> None:
    """`--reading`, one or more of the readings of the paper."""
    parser.add_argument(
        "--reading",
        nargs="+",
        choices=list(reference.READINGS),
        default=list(reference.READINGS),
        help="(default: both)",
    )
