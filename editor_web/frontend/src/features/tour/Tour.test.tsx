/** The tour: who is invited, what each step says, leaving it and going on with it. */
import { screen, waitFor } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { live, show } from '../../../testing/page'
import { endTour, openTour, setTour, useTour } from '../../api/tour'
import { END, STEPS } from './steps'
import { Tour } from './Tour'
import { TourInvitation } from './TourInvitation'

const MADE = 'behaviors/first.yaml'
const edited = vi.fn()

function Guide({ page = 'home', id = '' }: { readonly page?: string; readonly id?: string }) {
  const isOn = useTour((s) => s.isOn)
  return (
    <>
      <TourInvitation />
      {isOn && <Tour page={page} id={id} onEdit={edited} onBehavior={edited} />}
    </>
  )
}

afterEach(() => {
  endTour()
  setTour({ isSettled: false })
})

it('begins with an invitation, and puts the keyboard into it', async () => {
  live()
  const user = show(<Guide />)
  expect(screen.getByRole('region', { name: 'First steps' })).toHaveTextContent('New here?')
  await user.click(screen.getByRole('button', { name: 'Tour' }))
  expect(screen.queryByRole('region', { name: 'First steps' })).toBeNull()
  const card = screen.getByRole('region', { name: 'Tour' })
  expect(card).toHaveTextContent(`Step 1 of ${STEPS.length}`)
  expect(card).toHaveTextContent(STEPS[0]?.title ?? '')
  await waitFor(() => expect(card).toHaveFocus())
})

it('does not ask again who has said that he will not', async () => {
  const user = show(<Guide />)
  await user.click(screen.getByRole('button', { name: 'Not now' }))
  expect(screen.queryByRole('region')).toBeNull()
  expect(JSON.parse(localStorage.getItem('flexcell.tour') ?? '{}')).toMatchObject({ isSettled: true, isOn: false })
})

it('is not offered to who may make nothing', () => {
  live({}, 'viewer')
  show(<Guide />)
  expect(screen.queryByRole('button', { name: 'Tour' })).toBeNull()
})

it('keeps how far one has come when it is left', async () => {
  openTour()
  setTour({ step: 2, document: MADE })
  const user = show(<Guide page="edit" id={MADE} />)
  expect(screen.getByText(STEPS[2]?.title ?? '')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Leave the tour' }))
  expect(screen.queryByRole('region', { name: 'Tour' })).toBeNull()
  expect(JSON.parse(localStorage.getItem('flexcell.tour') ?? '{}')).toMatchObject({ step: 2, document: MADE })
})

it('leads back to the page where its step is done', async () => {
  edited.mockReset()
  openTour()
  setTour({ step: 2, document: MADE })
  const user = show(<Guide />)
  expect(screen.getByText('This is done with first.yaml, which is not on the page now.')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Go there' }))
  expect(edited.mock.calls).toEqual([[MADE]])
})

it('begins anew', async () => {
  openTour()
  setTour({ step: 2, document: MADE })
  const user = show(<Guide page="edit" id={MADE} />)
  await user.click(screen.getByRole('button', { name: 'Restart' }))
  expect(screen.getByText(`Step 1 of ${STEPS.length}`)).toBeVisible()
  expect(useTour.getState().document).toBe('')
})

it('ends with what can be done next', async () => {
  openTour()
  setTour({ step: STEPS.length, document: MADE })
  const user = show(<Guide />)
  expect(screen.getByText(END.title)).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Finish' }))
  expect(useTour.getState()).toMatchObject({ isOn: false, step: 0, isSettled: true })
})
