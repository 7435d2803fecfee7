/** What the page keeps of the answers of the server, and when it asks again. */
import { cleanup, screen, waitFor } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, run, server, show, snapshot } from '../../testing/page.tsx'
import { Refusal } from '../../testing/server.ts'
import { behaviorQueries } from './behaviorQueries'
import { useAnswer } from './queryClient'
import { relationQueries } from './relations'

const BEHAVIORS = 'GET /behaviors'

function Told() {
  const { value, problem } = useAnswer(behaviorQueries.all())
  return <p role="status">{problem ?? value?.map((each) => each.id).join() ?? 'waits'}</p>
}

function Interrupted() {
  useAnswer(behaviorQueries.interrupted())
  return null
}

function Referrers() {
  useAnswer(relationQueries.referrers('behaviors/nap.yaml'))
  useAnswer(relationQueries.referrers('behaviors/shift.yaml'))
  return null
}

/** How often it was asked. */
function times(what: string): number {
  return server().asked.filter((each) => each.what === what).length
}

async function told(words: string): Promise<void> {
  await waitFor(() => expect(screen.getByRole('status')).toHaveTextContent(words))
}

it('takes a refusal as the answer, and asks once', async () => {
  server().on(BEHAVIORS, new Refusal(422, { message: 'a file cannot be read', hint: 'mend it' }))
  show(<Told />)
  await told('a file cannot be read – mend it')
  expect(times(BEHAVIORS)).toBe(1)
})

it('asks again where nobody answers', async () => {
  let tries = 0
  vi.stubGlobal('fetch', () => {
    tries += 1
    return tries < 3 ? Promise.reject(new TypeError('Failed to fetch')) : Promise.resolve(Response.json([{ id: 'shift' }]))
  })
  show(<Told />)
  await told('shift')
  expect(tries).toBe(3)
})

it('keeps what is shown while it is logged out, and asks after the log-in', async () => {
  server().on(BEHAVIORS, [{ id: 'shift' }])
  const socket = live()
  show(<Told />)
  await told('shift')
  server().on(BEHAVIORS, new Refusal(401, { message: 'log in' }))
  socket.tell({ k: 'documents', changed: { shift: 'h2' } })
  await waitFor(() => expect(times(BEHAVIORS)).toBe(2))
  expect(screen.getByRole('status')).toHaveTextContent('shift')
  server().on(BEHAVIORS, [{ id: 'pick' }])
  socket.tell({ k: 'hello', version: 1, epoch: 'another server', role: 'operator', server_time_s: 1 })
  await told('pick')
})

it('asks again for what a written file and another run have made old, and for nothing else', async () => {
  server()
    .on(BEHAVIORS, [{ id: 'shift' }])
    .on('GET /interrupted', [])
  const socket = live()
  show(
    <>
      <Told />
      <Interrupted />
    </>,
  )
  await told('shift')
  server().on(BEHAVIORS, [{ id: 'pick' }])
  socket.tell({ k: 'documents', changed: { pick: 'h1' } })
  await told('pick')
  expect(times('GET /interrupted')).toBe(1)
  socket.tell(snapshot({ runs: [run()] }))
  await waitFor(() => expect(times('GET /interrupted')).toBe(2))
  expect(times(BEHAVIORS)).toBe(2)
})

it('asks again for what had no answer when the connection is there again', async () => {
  server().on(BEHAVIORS, new Refusal(503, { message: 'not now' }))
  const socket = live()
  show(<Told />)
  await told('not now')
  socket.cut()
  server().on(BEHAVIORS, [{ id: 'shift' }])
  await waitFor(() => expect(server().socket('/live')).not.toBe(socket))
  const next = server().socket('/live')
  next.accept()
  next.tell(snapshot())
  await told('shift')
})

it('knows nothing of what another page was told', async () => {
  server().on(BEHAVIORS, [{ id: 'shift' }])
  show(<Told />)
  await told('shift')
  cleanup()
  server().on(BEHAVIORS, () => new Promise(() => undefined))
  show(<Told />)
  expect(screen.getByRole('status')).toHaveTextContent('waits')
})

it('asks nothing of a document that is gone', async () => {
  const [gone, kept] = ['behaviors/nap.yaml', 'behaviors/shift.yaml'].map((id) => `GET /documents/${id}/referrers`) as [string, string]
  server().on(gone, []).on(kept, [])
  const socket = live()
  show(<Referrers />)
  await waitFor(() => expect(times(gone) + times(kept)).toBe(2))
  socket.tell({ k: 'documents', changed: { 'behaviors/nap.yaml': null } })
  await waitFor(() => expect(times(kept)).toBe(2))
  expect(times(gone)).toBe(1)
})
