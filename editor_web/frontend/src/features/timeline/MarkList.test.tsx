/** The marks are read and chosen without seeing the lanes, and what is missing is said. */
import { screen } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { show } from '../../../testing/page'
import type { MeasuredMarker } from '../../api/types'
import { withMeasured } from '../../document/measured'
import { MarkList } from './MarkList'

const CONTACT: MeasuredMarker = {
  kind: 'contact',
  seq: 4,
  time_s: 1.25,
  path: 'root/touch',
  device: 'left',
  value: 12.5,
  unit: 'N',
  limit: 10,
  text: 'left stopped at a contact after 20.0 mm',
}
const MARKS = withMeasured([{ seq: 1, time_s: 0.5, kind: 'goal', path: 'root/touch', text: 'left/move_until_contact' }], [CONTACT])
const MEASURED = { seq: 4, marks: [CONTACT], unread: '', every: 1, left_out: 0 }

it('goes to the mark that is pressed, by keys', async () => {
  const go = vi.fn()
  const user = show(<MarkList marks={MARKS} measured={MEASURED} cursorS={0.6} onGo={go} />)
  await user.click(screen.getByRole('button', { name: 'List of marks' }))
  expect(screen.getAllByRole('listitem')).toHaveLength(2)
  expect(screen.getByRole('button', { name: /^0.50 s · Goal/ })).toHaveAttribute('aria-current', 'step')
  screen.getByRole('button', { name: /^1.25 s · Contact · left stopped at a contact after 20.0 mm: 12.5 N, asked for 10 N/ }).focus()
  await user.keyboard('{Enter}')
  expect(go).toHaveBeenCalledWith(MARKS[1])
})

it('says what is not marked, and why', async () => {
  const measured = { ...MEASURED, unread: 'there is no recording of this run', every: 3, left_out: 7 }
  const user = show(<MarkList marks={[]} measured={measured} cursorS={0} onGo={vi.fn()} />)
  await user.click(screen.getByRole('button', { name: 'List of marks' }))
  expect(screen.getByText('Forces and limits of telemetry are missing: there is no recording of this run.')).toBeVisible()
  expect(screen.getByText('One message in 3 was read: peaks between them are missing.')).toBeVisible()
  expect(screen.getByText('7 more limits were left out.')).toBeVisible()
})
