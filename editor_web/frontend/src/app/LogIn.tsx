/** Over a page that is logged out: how to log in again without losing what stands in it. */
import { useEffect, useState, type FormEvent } from 'react'
import { api, wordsOf } from '../api/client'
import { logIn } from '../api/logIn'
import { useSession } from '../api/session'
import { Dialog } from '../components/Dialog'

const LOOK_MS = 2000

export function LogIn() {
  const isLoggedOut = useSession((s) => s.isLoggedOut)
  const [isAway, setAway] = useState(false)
  useEffect(() => {
    setAway(false)
    if (!isLoggedOut) return
    // Somebody may log in on another tab.
    const timer = setInterval(() => void api.session().catch(() => undefined), LOOK_MS)
    return () => clearInterval(timer)
  }, [isLoggedOut])
  if (!isLoggedOut) return null
  return (
    <>
      <div className="logged-out" role="alert">
        <span>
          <strong>You are logged out.</strong> Nothing can be commanded, apart from STOP.
        </span>
        <button type="button" className="command is-strong" onClick={() => setAway(false)}>
          Log in
        </button>
      </div>
      <Dialog isOpen={!isAway} title="You are logged out" onClose={() => setAway(true)}>
        <LogInForm />
      </Dialog>
    </>
  )
}

function LogInForm() {
  const [token, setToken] = useState('')
  const [problem, setProblem] = useState('')
  const [isAsking, setAsking] = useState(false)

  async function submit(event: FormEvent): Promise<void> {
    event.preventDefault()
    setAsking(true)
    try {
      setProblem(await logIn(token.trim()))
    } catch (error) {
      setProblem(`The server does not answer: ${wordsOf(error)}`)
    } finally {
      setAsking(false)
    }
  }

  return (
    <form className="log-in" onSubmit={(event) => void submit(event)}>
      <p>
        Open a new log-in link (<code>flexcell login</code> prints one) in any tab of this browser, or paste the token here. This page then
        goes on by itself; drafts are kept.
      </p>
      <label>
        Token
        <input
          type="password"
          autoComplete="current-password"
          required
          value={token}
          onChange={(event) => setToken(event.currentTarget.value)}
        />
      </label>
      {problem && (
        <p className="is-lost" role="alert">
          {problem}
        </p>
      )}
      <button type="submit" className="command is-strong" disabled={isAsking}>
        {isAsking ? 'Logging in' : 'Log in'}
      </button>
    </form>
  )
}
