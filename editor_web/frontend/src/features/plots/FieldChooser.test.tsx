/** Choosing numbers to plot, and the legend of what is plotted. */
import { screen, within } from '@testing-library/react'
import { useState } from 'react'
import { expect, it, vi } from 'vitest'
import { show } from '../../../testing/page'
import { Curves } from '../../document/curves'
import { FieldChooser } from './FieldChooser'
import { Legend } from './Legend'
import { MOST_CURVES } from './keptFields'

const JOINTS = Array.from({ length: 3 }, (_, at) => ({ path: `position_rad.${at}`, label: `position_rad ${at + 1}`, unit: 'rad' }))
const TOPICS = [
  { topic: 'left/joint_state', type: 'JointState', fields: JOINTS },
  { topic: 'left/gripper', type: 'GripperState', fields: [{ path: 'width_m', label: 'width_m', unit: 'm' }] },
]

const NONE: readonly string[] = []

function Chooser({ first = NONE }: { readonly first?: readonly string[] }) {
  const [fields, setFields] = useState(first)
  return (
    <>
      <FieldChooser topics={TOPICS} chosen={fields} onChoose={setFields} />
      <output aria-label="Chosen">{fields.join(' ')}</output>
    </>
  )
}

function chosen(): string[] {
  return (screen.getByLabelText('Chosen').textContent ?? '').split(' ').filter(Boolean)
}

it('chooses a row at once, or one number of it', async () => {
  const user = show(<Chooser />)
  await user.click(screen.getByRole('button', { name: /joint_state/ }))
  const all = screen.getByRole('checkbox', { name: 'All of position_rad of left/joint_state' })
  await user.click(all)
  expect(chosen()).toHaveLength(3)
  await user.click(screen.getByRole('button', { name: 'position_rad 2 of left/joint_state' }))
  expect(chosen()).toEqual(['left/joint_state:position_rad.0', 'left/joint_state:position_rad.2'])
  expect(all).toBePartiallyChecked()
  expect(screen.getByRole('button', { name: /left\/joint_state 2|joint_state.*2/ })).toBeVisible()
  await user.click(screen.getByRole('button', { name: /gripper/ }))
  await user.click(screen.getByRole('checkbox', { name: 'width_m of left/gripper' }))
  expect(chosen().at(-1)).toBe('left/gripper:width_m')
})

it('finds numbers by topic and name', async () => {
  const user = show(<Chooser />)
  await user.type(screen.getByLabelText('Find a number'), 'width')
  expect(screen.getByRole('checkbox', { name: 'width_m of left/gripper' })).toBeVisible()
  expect(screen.queryByRole('button', { name: /joint_state/ })).toBeNull()
  await user.type(screen.getByLabelText('Find a number'), ' torque')
  expect(screen.getByText('Nothing matches.')).toBeVisible()
})

it('takes no more than can be told apart', async () => {
  const many = Array.from({ length: MOST_CURVES }, (_, at) => `other:${at}`)
  const user = show(<Chooser first={many} />)
  expect(screen.getByText(`${MOST_CURVES} curves are the most.`)).toBeVisible()
  await user.click(screen.getByRole('button', { name: /gripper/ }))
  expect(screen.getByRole('checkbox', { name: 'width_m of left/gripper' })).toBeDisabled()
})

it('tells values now and where one points, and takes a curve away', async () => {
  const removed = vi.fn()
  const curves = new Curves(8)
  curves.choose(['left/gripper:width_m'])
  curves.push(1, [0.04])
  curves.push(2, [0.08])
  const entry = { id: 'left/gripper:width_m', topic: 'left/gripper', label: 'width_m', unit: 'm', color: 0 }
  const legend = (atS?: number) => <Legend entries={[entry]} curves={curves} atS={atS} endS={undefined} onRemove={removed} />
  const user = show(
    <>
      {legend()}
      {legend(1)}
    </>,
  )
  const [now, there] = screen.getAllByRole('list', { name: 'Curves' })
  expect(now).toHaveTextContent('width_m left/gripper0.08 m')
  expect(there).toHaveTextContent('0.04 m')
  await user.click(within(now ?? document.body).getByRole('button', { name: 'Take away width_m of left/gripper' }))
  expect(removed.mock.calls).toEqual([['left/gripper:width_m']])
})
