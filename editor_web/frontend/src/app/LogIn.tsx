/** Over a page that is logged out: how to log in again without losing what stands in it. */
import { Button, Code, Stack, Text, TextInput } from '@mantine/core'
import { IconLogout } from '@tabler/icons-react'
import { useEffect, useState, type FormEvent } from 'react'
import { DialogFooter } from '../components/DialogFooter'
import { api, wordsOf } from '../api/client'
import { logIn } from '../api/logIn'
import { useSession } from '../api/session'
import { Dialog } from '../components/Dialog'
import { Notice } from '../components/Notice'

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
      <Notice
        role="alert"
        icon={<IconLogout size={20} aria-hidden />}
        tools={
          <Button size="compact-sm" onClick={() => setAway(false)}>
            Log in
          </Button>
        }
      >
        <strong>You are logged out.</strong> Nothing can be commanded, apart from STOP.
      </Notice>
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
      setProblem(wordsOf(error))
    } finally {
      setAsking(false)
    }
  }

  return (
    <Stack component="form" gap="sm" w="min(26rem, 80vw)" onSubmit={(event) => void submit(event)}>
      <Text size="sm">
        Open a new log-in link (<Code>flexcell login</Code> prints one) in any tab of this browser, or paste the token here. This page then
        goes on by itself; drafts are kept.
      </Text>
      <TextInput
        type="password"
        label="Token"
        autoComplete="current-password"
        required
        withAsterisk={false}
        value={token}
        onChange={(event) => setToken(event.currentTarget.value)}
      />
      <DialogFooter refusal={problem}>
        <Button type="submit" disabled={isAsking}>
          {isAsking ? 'Logging in' : 'Log in'}
        </Button>
      </DialogFooter>
    </Stack>
  )
}
