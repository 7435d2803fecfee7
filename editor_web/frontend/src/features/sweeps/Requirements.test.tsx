import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { show } from '../../../testing/page'
import type { JudgedRequirement } from '../../api/types'
import { Requirements } from './Requirements'

const SUCCESS: JudgedRequirement = {
  text: 'success >= 0.98',
  number: null,
  runs: 20,
  kept: 20,
  missing: 0,
  interval: [0.8, 1],
  verdict: 'undecided',
}
const FORCE: JudgedRequirement = {
  text: 'share(cell.contact_force_max_n <= 30) >= 0.95',
  number: 'cell.contact_force_max_n',
  runs: 20,
  kept: 12,
  missing: 3,
  interval: [0.35, 0.8],
  verdict: 'failed',
}

it('tells of each requirement how many runs keep it, and whether that is enough', () => {
  show(<Requirements requirements={[SUCCESS, FORCE]} />)
  const [head, success, force] = screen.getAllByRole('row')
  expect(head).toHaveTextContent('RequiredRuns that keep itInterval')
  expect(success).toHaveTextContent('undecided: success >= 0.9820 of 2080.0 % to 100.0 %')
  expect(force).toHaveTextContent('failed: share(cell.contact_force_max_n <= 30) >= 0.9512 of 20 (3 without the number)35.0 % to 80.0 %')
})

it('leaves a success rate alone to the badge and the curve', () => {
  show(<Requirements requirements={[SUCCESS]} />)
  expect(screen.queryByRole('group')).toBeNull()
})

it('has no interval where the design has none', () => {
  show(<Requirements requirements={[{ ...FORCE, interval: null, missing: 0, verdict: 'undecided', runs: 0, kept: 0 }]} />)
  expect(screen.getAllByRole('row')[1]).toHaveTextContent('undecided: share(cell.contact_force_max_n <= 30) >= 0.950 of 0')
})
