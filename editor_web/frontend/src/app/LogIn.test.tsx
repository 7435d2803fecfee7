/** Logging in again over a page that is logged out. */
import { act, screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { server, session, show } from '../../testing/page'
import { Refusal } from '../../testing/server'
import { api } from '../api/client'
import { LogIn } from './LogIn'

const LOGIN = 'POST /login'

/** A page whose session has ended. */
beforeEach(async () => {
  server().on('GET /session', new Refusal(401, { message: 'log in first' }))
  await api.session().catch(() => undefined)
})

function overlay() {
  return within(screen.getByRole('dialog', { name: 'You are logged out' }))
}

it('takes a token, and says of a wrong one that it is not valid', async () => {
  server().on(LOGIN, new Refusal(401, {}))
  const user = show(<LogIn />)
  expect(overlay().getByText('flexcell login')).toBeVisible()
  await user.type(overlay().getByLabelText('Token'), 'wrong')
  await user.click(overlay().getByRole('button', { name: 'Log in' }))
  expect(await overlay().findByRole('alert')).toHaveTextContent('That token is not valid for this server.')
  // Not before it is taken: the page looks by itself whether somebody else has logged in.
  server().on(LOGIN, () => void server().on('GET /session', session()))
  await user.clear(overlay().getByLabelText('Token'))
  await user.type(overlay().getByLabelText('Token'), ' right ')
  await user.click(overlay().getByRole('button', { name: 'Log in' }))
  await waitFor(() => expect(screen.queryByRole('dialog')).toBeNull())
  expect(server().bodies(LOGIN)).toEqual([{ token: 'wrong' }, { token: 'right' }])
})

it.each([
  [new Refusal(429, {}), 'Too many wrong tokens. Wait some seconds, then try again.'],
  [() => Promise.reject(new TypeError('Failed to fetch')), 'The server does not answer'],
])('says why it was refused otherwise', async (answer, words) => {
  server().on(LOGIN, answer)
  const user = show(<LogIn />)
  await user.type(overlay().getByLabelText('Token'), 'token{Enter}')
  expect(await overlay().findByRole('alert')).toHaveTextContent(words)
})

it('can be put away to look at what stands there, and goes when another tab has logged in', async () => {
  const user = show(<LogIn />)
  await user.click(overlay().getByRole('button', { name: 'Close' }))
  expect(screen.queryByRole('dialog')).toBeNull()
  const bar = screen.getByRole('alert')
  expect(bar).toHaveTextContent('Nothing can be commanded, apart from STOP.')
  await user.click(within(bar).getByRole('button', { name: 'Log in' }))
  expect(overlay().getByLabelText('Token')).toBeVisible()
  server().on('GET /session', session())
  await act(() => api.session())
  expect(screen.queryByRole('alert')).toBeNull()
})

it('is not there for who is logged in', async () => {
  server().on('GET /session', session())
  await api.session()
  show(<LogIn />)
  expect(screen.queryByRole('alert')).toBeNull()
})
