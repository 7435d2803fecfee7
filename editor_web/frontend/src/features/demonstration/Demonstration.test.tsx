/** From demonstration to behavior: steps in their order, what they will do, and making it. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { DemonstrationBody, EntryName, ProposalBody } from '../../api/types'
import { Demonstration } from './Demonstration'

const ENTRIES: readonly EntryName[] = [
  { kind: 'joints', name: 'above' },
  { kind: 'pose', name: 'tray' },
  { kind: 'trajectory', name: 'sweep' },
  { kind: 'record', name: 'note' },
]
const ROLES: Record<string, ProposalBody['steps'][number]['role']> = { above: 'approach', tray: 'grasp', sweep: 'follow', close: 'close' }
const PROPOSAL = 'POST /teach/proposal'
const made = vi.fn()

function proposal({ steps, id }: DemonstrationBody): Partial<ProposalBody> {
  return {
    id: id ?? '',
    steps: steps.map(({ kind, name, role, part }) => ({ kind, name, role: role ?? ROLES[name] ?? 'via', part: part ?? null })),
    words: steps.map(({ name }) => `goes to ${name}`),
    remarks: ['nothing says where it begins'],
    arm: 'left',
    arms: ['left', 'right'],
    parts: ['cup'],
    findings: [],
  }
}

function wanted(): DemonstrationBody | undefined {
  return server().bodies(PROPOSAL).at(-1) as DemonstrationBody | undefined
}

function names(): (string | null)[] {
  return within(screen.getByRole('region', { name: 'Steps' }))
    .queryAllByRole('listitem')
    .map((each) => each.getAttribute('aria-label'))
}

beforeEach(() => {
  made.mockReset()
  server()
    .on('GET /catalogue', { states: [], containers: [], behaviors: [], entries: ENTRIES, names: {} })
    .on(PROPOSAL, ({ body }: { body: DemonstrationBody }) => proposal(body))
})

it('offers what was taught, and says what its steps will do', async () => {
  const user = show(<Demonstration onMade={made} />)
  expect(screen.getByText('Shown here as soon as there is a step.')).toBeVisible()
  await user.click(await screen.findByRole('button', { name: 'Add joints above' }))
  await user.click(screen.getByRole('button', { name: 'Add pose tray' }))
  await user.click(screen.getByRole('button', { name: 'Close gripper' }))
  expect(screen.queryByRole('button', { name: /note/ })).toBeNull()
  expect(names()).toEqual(['Step 1: above', 'Step 2: tray', 'Step 3: Close gripper'])
  const words = await screen.findByText('goes to close')
  expect(
    within(screen.getByRole('region', { name: 'Resulting steps' }))
      .getAllByRole('listitem')
      .map((each) => each.textContent),
  ).toEqual(['goes to above', 'goes to tray', words.textContent])
  expect(screen.getByText('nothing says where it begins')).toBeVisible()
  expect(screen.getByLabelText('What tray is for')).toHaveValue('grasp')
})

it('changes the order, takes steps away, and says what a step is for', async () => {
  const user = show(<Demonstration onMade={made} />)
  await user.click(await screen.findByRole('button', { name: 'Add joints above' }))
  await user.click(screen.getByRole('button', { name: 'Add pose tray' }))
  await user.click(screen.getByRole('button', { name: 'Add recording sweep' }))
  const step = (name: RegExp) => within(screen.getByRole('listitem', { name }))
  await user.click(step(/tray/).getByRole('button', { name: 'Earlier' }))
  expect(names()).toEqual(['Step 1: tray', 'Step 2: above', 'Step 3: sweep'])
  expect(step(/tray/).getByRole('button', { name: 'Earlier' })).toBeDisabled()
  await user.click(step(/sweep/).getByRole('button', { name: 'Remove' }))
  await user.selectOptions(await screen.findByLabelText('What above is for'), 'depart')
  await waitFor(() =>
    expect(wanted()?.steps).toEqual([
      { kind: 'pose', name: 'tray' },
      { kind: 'joints', name: 'above', role: 'depart' },
    ]),
  )
  await user.selectOptions(await screen.findByLabelText('Grasped part'), 'cup')
  await waitFor(() => expect(wanted()?.steps[0]).toEqual({ kind: 'pose', name: 'tray', part: 'cup' }))
})

it('finds what was taught by its words', async () => {
  const user = show(<Demonstration onMade={made} />)
  await screen.findByRole('button', { name: 'Add joints above' })
  await user.type(screen.getByLabelText('Find a taught entry'), 'recording')
  expect(screen.getAllByRole('button', { name: /^Add/ }).map((each) => each.getAttribute('aria-label'))).toEqual(['Add recording sweep'])
  await user.type(screen.getByLabelText('Find a taught entry'), ' above')
  expect(screen.getByText('No entry fits.')).toBeVisible()
})

it('is made under a name, in the arm that is chosen', async () => {
  const user = show(<Demonstration onMade={made} />)
  await user.click(screen.getByRole('button', { name: 'Create and open' }))
  expect(screen.getByRole('alert')).toHaveTextContent('There is nothing to be done yet')
  await user.click(await screen.findByRole('button', { name: 'Add joints above' }))
  await screen.findByText('goes to above')
  await user.selectOptions(screen.getByLabelText('Arm'), 'right')
  await user.type(screen.getByLabelText('Name'), 'taught transfer')
  expect(screen.getByText('behaviors/taught_transfer.yaml')).toBeVisible()
  await screen.findByText('goes to above')
  await user.click(screen.getByRole('button', { name: 'Create and open' }))
  await waitFor(() => expect(made.mock.calls).toEqual([['behaviors/taught_transfer.yaml']]))
  // What is proposed for the chosen arm may be asked for after it.
  const written = (server().bodies(PROPOSAL) as DemonstrationBody[]).filter((body) => body.id)
  expect(written).toMatchObject([
    { id: 'behaviors/taught_transfer.yaml', options: { arm: 'right' }, steps: [{ kind: 'joints', name: 'above' }] },
  ])
})

it('says why there is no proposal', async () => {
  server().on(PROPOSAL, new Refusal(422, { message: 'no arm has these joints', hint: 'choose an arm' }))
  const user = show(<Demonstration onMade={made} />)
  await user.click(await screen.findByRole('button', { name: 'Add joints above' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('no arm has these joints – choose an arm')
})
