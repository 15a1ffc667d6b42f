"""What paper 004 claims of its filters, and whether the runs confirm it."""

from collections.abc import Callable

from ...evaluation.report import Claim
from ...evaluation.result import BORNE_OUT, IN_PART, NOT_BORNE_OUT
from ...extent.input_noise import VARIANTS
from .figures import CASES, Findings
from .trials import RANDOM_MATRIX, ExtendedTrial

SOURCE = 'paper 004'
PAPERS = ('gp', 'gp_ts', 'gp_ss', 'gp_mc')  # its four filters
NOISY = PAPERS[1:]
CLOSE = 1.25  # largest error over the smallest at which errors still count as close


def claims(found: Findings) -> list[Claim]:
    """Each claim with the figures of all cases and the verdict."""
    cases = {
        case: {name: found[case, name] for name in (*VARIANTS, RANDOM_MATRIX)} for case in CASES
    }

    def told(
        claim: str,
        holds: Callable[[dict[str, ExtendedTrial]], bool],
        show: Callable[[ExtendedTrial], str],
        names=PAPERS,
        note: str = '',
    ) -> Claim:
        kept = [case for case in cases if holds(cases[case])]
        values = '; '.join(
            f'{case}: ' + ', '.join(f'{name} {show(cases[case][name])}' for name in names)
            for case in cases
        )
        where = '' if len(kept) in (0, len(cases)) else f'; holds in {" and ".join(kept)}'
        return Claim(
            SOURCE,
            claim,
            values + where + note,
            BORNE_OUT if len(kept) == len(cases) else IN_PART if kept else NOT_BORNE_OUT,
        )

    return [
        told(
            'the Mahalanobis distance is smaller with input noise',
            lambda of: max(of[name].mahalanobis for name in NOISY) < of['gp'].mahalanobis,
            lambda trial: f'{trial.mahalanobis:.1f}',
            note='; about 6 where the covariance is right',
        ),
        told(
            'the uncertainty covers the truth better with input noise',
            lambda of: min(of[name].coverage for name in NOISY) > of['gp'].coverage,
            lambda trial: f'{trial.coverage:.2f}',
        ),
        told(
            'GP-MC is the best of the four',
            lambda of: min(PAPERS, key=lambda name: of[name].rmse) == 'gp_mc',
            lambda trial: f'{trial.rmse:.2f} m',
        ),
        told(
            'the errors of the four are close to each other',
            lambda of: (
                max(of[name].rmse for name in PAPERS)
                <= CLOSE * min(of[name].rmse for name in PAPERS)
            ),
            lambda trial: f'{trial.rmse:.2f} m',
            note=f'; close is within {CLOSE - 1:.0%}',
        ),
        told(
            'the PCRLB is more conservative with input noise',
            lambda of: min(of[name].bound for name in NOISY) > of['gp'].bound,
            lambda trial: f'{trial.bound:.2f} m',
            note='; more noise is counted, so it could not be otherwise',
        ),
        told(
            'the outline is estimated better than by a random matrix',
            lambda of: min(of[name].shape for name in PAPERS) < of[RANDOM_MATRIX].shape,
            lambda trial: f'{trial.shape:.2f} m',
            (*PAPERS, RANDOM_MATRIX),
            note='; RMS off the true outline where it truly lies',
        ),
    ]
